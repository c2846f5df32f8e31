#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"
#include "trees/buffer.h"
#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/layouts/layouts.h"
#include "trees/tree.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

/// Rays at a mesh, over any layout. Those of a batch take turns (traversals/rays/ray_wave-inl.h),
/// so they are best handed over many at a time; single_rays.h is for who has one.
namespace boxwood {

enum class RayQuery : std::uint8_t {
    closest, ///< the hit with the least t, ties to the lowest triangle index
    any      ///< whether there is a hit at all: some hit, not always the same between layouts
};

/// What rays read of a layout: the triangles of a mesh in blocks of four or eight, and above them a
/// copy of the inner nodes that knows where those are (traversals/rays/ray_tree.h).
struct TriangleBlocks {
    Buffer<std::byte> nodes, blocks;
    std::uint32_t root = 0;
    Box bounds; ///< of all triangles

    std::size_t bytes() const { return nodes.bytes() + blocks.bytes(); }
};

/// Where all hits of a ray go: by chunks as PairSink, a ray's hits in one batch, by t and then by
/// triangle; a ray without hits is skipped.
class HitSink {
  public:
    virtual ~HitSink() = default;
    virtual void begin(std::size_t chunks, bool in_order) = 0;
    virtual bool take(std::size_t chunk, std::uint32_t ray, std::span<const RayHit> hits) = 0;
    virtual void end() = 0;
};

/// triangles_of: the triangles of the mesh whose triangle boxes the layout was made of; the same on
/// every executor. A mesh with a coordinate of max_ray_coordinate, 2^126, or more throws
/// std::invalid_argument. The other queries take those of this very layout and a `kernel` by its
/// name (std::invalid_argument for an unknown one). Origins and directions must be below 2^126 too,
/// else kernels but `exact` may miss; a ray that is not finite is a miss. What is so far that t
/// rounds to infinity is a miss for every kernel (kernels/ray_triangle/ray_kernel.h). rays: hits[i]
/// answers rays[i]; hits.size() == rays.size(), else std::invalid_argument. `work`, if given, is
/// added to, and the executor must be serial(). rays_all: every hit of every ray with t_min <= t <=
/// t_max, each triangle once.
#define X(name, L)                                                                                 \
    TriangleBlocks triangles_of(const L& layout, const TriangleMesh& mesh,                         \
                                const Executor& executor);                                         \
    void rays(const L& layout, std::span<const Ray<float>> rays, RayQuery query,                   \
              std::string_view kernel, const TriangleBlocks& triangles, const Executor& executor,  \
              std::span<RayHit> hits, Work* work = nullptr);                                       \
    void rays_all(const L& layout, std::span<const Ray<float>> rays, std::string_view kernel,      \
                  const TriangleBlocks& triangles, const Executor& executor, HitSink& sink);
BOXWOOD_TRAVERSED_LAYOUTS(X)
#undef X

/// `rays` on one thread, with the work counted.
template <class L>
Work rays_counted(const L& layout, std::span<const Ray<float>> batch, RayQuery query,
                  std::string_view kernel, const TriangleBlocks& triangles,
                  std::span<RayHit> hits) {
    Work work;
    rays(layout, batch, query, kernel, triangles, serial(), hits, &work);
    return work;
}

} // namespace boxwood
