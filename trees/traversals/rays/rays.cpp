#include "trees/queries/rays.h"
#include "trees/layouts/binary.h"
#include "trees/traversals/rays/ray_traversal.h"
#include "trees/traversals/rays/ray_tree.h"

namespace boxwood::detail {

#define X(name, L)                                                                                 \
    void traverse_rays(const L&, const RayJob& job) { traverse_nodes<RayNodeOf<L>>(job); }
BOXWOOD_LANE_LAYOUTS(X)
#undef X

} // namespace boxwood::detail

namespace boxwood {

#define X(name, L)                                                                                 \
    SingleRayFunctions single_ray_functions(const L& layout, std::string_view kernel) {            \
        return detail::single_ray_functions_of<detail::RayNodeOf<L>>(layout.depth(), kernel);      \
    }
BOXWOOD_LANE_LAYOUTS(X)
#undef X

#define X(name, L)                                                                                 \
    void rays(const L& layout, std::span<const Ray<float>> rays, RayQuery query,                   \
              std::string_view kernel, const TriangleBlocks& triangles, const Executor& executor,  \
              std::span<RayHit> hits, Work* work) {                                                \
        using detail::RayMode;                                                                     \
        const RayMode mode = query == RayQuery::any ? RayMode::any : RayMode::closest;             \
        detail::for_ray_chunks(                                                                    \
            {rays, mode, kernel, triangles, layout.depth(), hits, nullptr, work}, executor,        \
            [&](const detail::RayJob& part) { traverse_rays(layout, part); });                     \
    }                                                                                              \
    void rays_all(const L& layout, std::span<const Ray<float>> rays, std::string_view kernel,      \
                  const TriangleBlocks& triangles, const Executor& executor, HitSink& sink) {      \
        detail::for_ray_chunks(                                                                    \
            {rays, detail::RayMode::all, kernel, triangles, layout.depth(), {}, &sink}, executor,  \
            [&](const detail::RayJob& part) { traverse_rays(layout, part); });                     \
    }
BOXWOOD_TRAVERSED_LAYOUTS(X)
#undef X

} // namespace boxwood
