#pragma once

#include "bench/stages/playing.h"
#include "trees/layout.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace boxwood::bench {

/// The two triangles of each side of a box, by its corners: bit 0 of a corner's number is x, bit 1
/// y, bit 2 z, set if it lies at the maximum.
inline constexpr std::array<std::array<std::uint32_t, 3>, 12> box_triangles{{{0, 2, 1},
                                                                             {1, 2, 3},
                                                                             {4, 5, 6},
                                                                             {5, 7, 6},
                                                                             {0, 1, 4},
                                                                             {1, 5, 4},
                                                                             {2, 6, 3},
                                                                             {3, 6, 7},
                                                                             {0, 4, 2},
                                                                             {2, 4, 6},
                                                                             {1, 3, 5},
                                                                             {3, 7, 5}}};

/// All that rays may hit: the triangles of the present bodies, in floats as they stand in the
/// scene, body by body.
TriangleMesh surface_mesh(const Bodies& bodies, std::vector<std::uint32_t>& first_triangle);

/// A tree of these triangles.
class Surface {
  public:
    /// moves: it will be made anew soon.
    Surface(const Bodies& bodies, bool moves, const Executor& executor);

    void hits(std::span<const Ray<float>> rays, const Executor& executor,
              std::vector<SurfaceHit>& out) const;
    std::size_t triangles() const { return mesh_.triangles.size(); }
    std::size_t bytes() const;

  private:
    std::vector<std::uint32_t> first_triangle_; ///< of each body, and the number of all
    TriangleMesh mesh_;
    std::unique_ptr<AnyLayout> layout_;
    TriangleBlocks blocks_;
};

} // namespace boxwood::bench
