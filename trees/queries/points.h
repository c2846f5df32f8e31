#pragma once

#include "trees/layouts/binary.h"
#include "trees/layouts/packed.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"
#include "trees/traversals/nearest_walk.h"
#include "trees/traversals/region_walk.h"

#include <stdexcept>

/// Queries of points and regions, over any layout; AnyLayout says what each answers.
namespace boxwood {

/// The layouts whose blocks load as SIMD lanes (lanes-inl.h), and the others.
#define BOXWOOD_LANE_LAYOUTS(X)                                                                    \
    X(Wide4Layout)                                                                                 \
    X(Wide8Layout) X(Wide16Layout) X(Wide8LayoutF64) X(Quantised8Layout) X(PackedLayout)
#define BOXWOOD_BINARY_LAYOUTS(X) X(BinaryLayout) X(BinaryLayoutF64)

/// The walks over a layout that is not empty: walk_regions answers the queries [first, last) of one
/// chunk, the others one finite point.
#define X(L)                                                                                       \
    void walk_regions(const L& layout, const RegionQueries& queries, RegionWalk& walk,             \
                      std::size_t first, std::size_t last);                                        \
    void walk_nearest(const L& layout, Vec3<float> point, NearestItems& best, NearestWalk& walk);  \
    void walk_closest_point(const L& layout, Vec3<float> point, NearestSurface& best,              \
                            NearestWalk& walk);
BOXWOOD_LANE_LAYOUTS(X)
BOXWOOD_BINARY_LAYOUTS(X)
#undef X

/// The most references that wait in one walk: opening a node leaves all but one of its children.
template <class L> std::size_t walk_room(const L& layout) {
    if constexpr (requires { L::width; })
        return layout.depth() * L::width + L::width;
    else
        return 2 * layout.depth() + 2;
}

namespace point_queries {

template <class L>
void regions(const L& layout, const RegionQueries& queries, const Executor& executor,
             PairSink& sink, Work* work) {
    const std::size_t n = layout.empty() ? 0 : queries.size();
    run_regions(n, walk_room(layout), executor, sink, work,
                [&](RegionWalk& walk, std::size_t first, std::size_t last) {
                    walk_regions(layout, queries, walk, first, last);
                });
}

} // namespace point_queries

template <class L>
void points(const L& layout, std::span<const Vec3<float>> points, const Executor& executor,
            PairSink& sink, Work* work) {
    point_queries::regions(layout, {.points = points}, executor, sink, work);
}
template <class L>
void regions(const L& layout, std::span<const Box> regions, const Executor& executor,
             PairSink& sink, Work* work) {
    point_queries::regions(layout, {.boxes = regions}, executor, sink, work);
}
template <class L>
void regions(const L& layout, std::span<const Sphere<float>> regions, const Executor& executor,
             PairSink& sink, Work* work) {
    point_queries::regions(layout, {.spheres = regions}, executor, sink, work);
}

template <class L>
void nearest(const L& layout, std::span<const Vec3<float>> points, std::size_t k,
             const Executor& executor, std::span<Neighbour> out, Work* work) {
    if (out.size() != k * points.size())
        throw std::invalid_argument("nearest: k neighbours per point are wanted");
    if (k == 0)
        return;
    run_nearest(points.size(), walk_room(layout), executor, work,
                [&](NearestWalk& walk, std::size_t first, std::size_t last) {
                    for (std::size_t i = first; i < last; ++i) {
                        NearestItems best(out.subspan(i * k, k));
                        if (!layout.empty() && is_finite(points[i]))
                            walk_nearest(layout, points[i], best, walk);
                        walk.answered(best.finish());
                    }
                });
}

template <class L>
void closest_points(const L& layout, std::span<const Vec3<float>> points, const TriangleMesh& mesh,
                    const Executor& executor, std::span<SurfacePoint> out, Work* work) {
    if (out.size() != points.size())
        throw std::invalid_argument("closest_points: one answer per point is wanted");
    run_nearest(points.size(), walk_room(layout), executor, work,
                [&](NearestWalk& walk, std::size_t first, std::size_t last) {
                    for (std::size_t i = first; i < last; ++i) {
                        NearestSurface best(points[i], mesh);
                        if (!layout.empty() && is_finite(points[i]))
                            walk_closest_point(layout, points[i], best, walk);
                        out[i] = best.result();
                        walk.answered(out[i].triangle != Neighbour::none);
                    }
                });
}

} // namespace boxwood
