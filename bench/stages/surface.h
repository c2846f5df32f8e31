#pragma once

#include "bench/stages/body_surface.h"
#include "bench/stages/playing.h"

#include <cstddef>
#include <span>
#include <vector>

namespace boxwood::bench {

/// What rays meet: a tree of all bodies that follows those that move. Where there are enough rays,
/// the bodies that no effect is laid on have one of their own, made once and with care; a ray then
/// goes through both, and takes the nearer hit.
class Surface {
  public:
    explicit Surface(const Playing& playing);

    /// Takes what has changed since it was made or last followed, each body once; gives the number
    /// of triangles written.
    std::size_t follow(const Playing& playing, std::span<const std::uint32_t> changed);
    void hits(std::span<const Ray<float>> rays, const Executor& executor,
              std::vector<SurfaceHit>& out) const;
    std::size_t triangles() const;
    std::size_t bytes() const;

  private:
    std::vector<BodySurface> parts_; ///< what may move, then what rests; none of no bodies
};

} // namespace boxwood::bench
