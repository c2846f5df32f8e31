#include "trees/dynamic/dynamic_tree.h"
#include "trees/layouts/binary.h"
#include "trees/layouts/packed.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"
#include "trees/queries/nearest.h"
#include "trees/queries/points.h"
#include "trees/queries/regions.h"
#include "trees/traversals/nearest_traversal.h"
#include "trees/traversals/region_traversal.h"

#include <stdexcept>

namespace boxwood::detail {
namespace {

template <class L>
void find_items(const L& layout, const RegionQueries& queries, const Executor& executor,
                PairSink& sink, Work* work) {
    const std::size_t n = layout.empty() ? 0 : queries.size();
    run_regions(n, stack_room(layout), executor, sink, work,
                [&](RegionTraversal& traversal, std::size_t first, std::size_t last) {
                    traverse_regions(layout, queries, traversal, first, last);
                });
}

template <class L>
void find_nearest(const L& layout, std::span<const Vec3<float>> points, std::size_t k,
                  const Executor& executor, std::span<Neighbour> out, Work* work) {
    if (out.size() != k * points.size())
        throw std::invalid_argument("nearest: k neighbours per point are wanted");
    if (k == 0)
        return;
    for_points(layout, points, executor, work, [&](NearestTraversal& traversal, std::size_t i) {
        NearestItems best(out.subspan(i * k, k));
        if (!layout.empty() && is_finite(points[i]))
            traverse_nearest(layout, points[i], best, traversal);
        traversal.answered(best.finish());
    });
}

template <class L>
void find_closest(const L& layout, std::span<const Vec3<float>> points, const TriangleMesh& mesh,
                  const Executor& executor, std::span<SurfacePoint> out, Work* work) {
    if (out.size() != points.size())
        throw std::invalid_argument("closest_points: one answer per point is wanted");
    for_points(layout, points, executor, work, [&](NearestTraversal& traversal, std::size_t i) {
        NearestSurface best(points[i], mesh);
        if (!layout.empty() && is_finite(points[i]))
            traverse_closest_point(layout, points[i], best, traversal);
        out[i] = best.result();
        traversal.answered(out[i].triangle != Neighbour::none);
    });
}

} // namespace
} // namespace boxwood::detail

namespace boxwood {

#define X(name, L)                                                                                 \
    void points(const L& layout, std::span<const Vec3<float>> points, const Executor& executor,    \
                PairSink& sink, Work* work) {                                                      \
        detail::find_items(layout, {.points = points}, executor, sink, work);                      \
    }                                                                                              \
    void regions(const L& layout, std::span<const Box> regions, const Executor& executor,          \
                 PairSink& sink, Work* work) {                                                     \
        detail::find_items(layout, {.boxes = regions}, executor, sink, work);                      \
    }                                                                                              \
    void regions(const L& layout, std::span<const Sphere<float>> regions,                          \
                 const Executor& executor, PairSink& sink, Work* work) {                           \
        detail::find_items(layout, {.spheres = regions}, executor, sink, work);                    \
    }                                                                                              \
    void nearest(const L& layout, std::span<const Vec3<float>> points, std::size_t k,              \
                 const Executor& executor, std::span<Neighbour> out, Work* work) {                 \
        detail::find_nearest(layout, points, k, executor, out, work);                              \
    }                                                                                              \
    void closest_points(const L& layout, std::span<const Vec3<float>> points,                      \
                        const TriangleMesh& mesh, const Executor& executor,                        \
                        std::span<SurfacePoint> out, Work* work) {                                 \
        detail::find_closest(layout, points, mesh, executor, out, work);                           \
    }
BOXWOOD_SEARCHED_TREES(X)
#undef X

} // namespace boxwood
