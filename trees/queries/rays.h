#pragma once

#include "trees/layouts/binary.h"
#include "trees/traversals/ray_tree.h"
#include "trees/traversals/ray_walk.h"

/// Rays at a mesh, over any layout; AnyLayout says what each query answers. Those of a batch take
/// turns (ray_wave-inl.h), at best many in one call. An unknown kernel throws
/// std::invalid_argument.
namespace boxwood {

#define BOXWOOD_RAY_LAYOUTS(X)                                                                     \
    X(BinaryLayout)                                                                                \
    X(BinaryLayoutF64)                                                                             \
    X(Wide4Layout)                                                                                 \
    X(Wide8Layout) X(Wide16Layout) X(Wide8LayoutF64) X(Quantised8Layout) X(PackedLayout)

/// The triangles of the mesh whose triangle boxes the layout was built from, as its walk wants
/// them; the walk over one chunk of rays; and those of one ray, if there are any.
#define X(L)                                                                                       \
    TriangleBlocks triangles_of(const L& layout, const TriangleMesh& mesh,                         \
                                const Executor& executor);                                         \
    void walk_rays(const L& layout, const RayJob& job);                                            \
    SingleRayWalks single_ray_walks(const L& layout, std::string_view kernel);
BOXWOOD_RAY_LAYOUTS(X)
#undef X

template <class L>
void rays(const L& layout, std::span<const Ray<float>> rays, RayQuery query,
          std::string_view kernel, const TriangleBlocks& triangles, const Executor& executor,
          std::span<RayHit> hits, Work* work = nullptr) {
    const RayMode mode = query == RayQuery::any ? RayMode::any : RayMode::closest;
    const RayJob job{rays, mode, kernel, triangles, layout.depth(), hits, nullptr, work};
    for_ray_chunks(job, executor, [&](const RayJob& part) { walk_rays(layout, part); });
}

/// The same on one thread, with the work counted.
template <class L>
Work rays_counted(const L& layout, std::span<const Ray<float>> rays, RayQuery query,
                  std::string_view kernel, const TriangleBlocks& triangles,
                  std::span<RayHit> hits) {
    Work work;
    boxwood::rays(layout, rays, query, kernel, triangles, serial(), hits, &work);
    return work;
}

template <class L>
void rays_all(const L& layout, std::span<const Ray<float>> rays, std::string_view kernel,
              const TriangleBlocks& triangles, const Executor& executor, HitSink& sink) {
    const RayJob job{rays, RayMode::all, kernel, triangles, layout.depth(), {}, &sink};
    for_ray_chunks(job, executor, [&](const RayJob& part) { walk_rays(layout, part); });
}

} // namespace boxwood
