#include "trees/traversals/binary_tree.h"
#include "trees/traversals/nearest_traversal.h"
#include "trees/traversals/region_traversal.h"

namespace boxwood::detail {
namespace {

/// Opens every node that the region takes, the left child first; hands over the leaves' items.
template <bool Counted, class L, class Takes>
void collect(const L& layout, const Takes& takes, RegionTraversal& traversal) {
    const auto& tree = tree_of(layout);
    std::uint32_t* const stack = traversal.stack();
    stack[0] = 0;
    for (std::size_t top = 1; top != 0;) {
        const std::uint32_t node = stack[--top];
        traversal.count<Counted>(1, top);
        if (!takes(tree.bounds(node)))
            continue;
        if (tree.is_leaf(node)) {
            *traversal.items_to() = tree.item(node);
            traversal.found(1);
            continue;
        }
        stack[top++] = right_of(tree, node);
        stack[top++] = left_of(tree, node);
    }
}

template <bool Counted, class L>
void answer(const L& layout, const RegionQueries& queries, RegionTraversal& traversal,
            std::size_t first, std::size_t last) {
    using Bounds = Aabb<typename L::Real>;
    const auto box = [&](const auto& region) {
        const std::optional<Box> b = finite_region(region);
        if (!b)
            return;
        using Corner = Vec3<typename L::Real>;
        const Bounds wanted{Corner(b->min), Corner(b->max)};
        collect<Counted>(
            layout, [&](const Bounds& bounds) { return overlaps(bounds, wanted); }, traversal);
    };
    const auto ball = [&](const Sphere<float>& sphere) {
        if (!is_region(sphere))
            return;
        const double radius = static_cast<double>(sphere.radius);
        collect<Counted>(
            layout,
            [&](const Bounds& bounds) {
                return squared_distance(sphere.centre, bounds) <= radius * radius;
            },
            traversal);
    };
    for (std::size_t i = first; i < last; ++i) {
        if (!queries.points.empty())
            box(queries.points[i]);
        else if (!queries.boxes.empty())
            box(queries.boxes[i]);
        else
            ball(queries.spheres[i]);
        std::ranges::sort(traversal.items());
        if (!traversal.answer(static_cast<std::uint32_t>(i)))
            return;
    }
}

/// All nodes that may be near enough, the nearer child first.
template <bool Counted, class L, class Best>
void search(const L& layout, Vec3<float> point, Best& best, NearestTraversal& traversal) {
    const auto& tree = tree_of(layout);
    const DistanceScale scaled(point, layout.bounds());
    float bound = std::numeric_limits<float>::infinity();
    std::uint64_t* const stack = traversal.stack();
    stack[0] = NearestTraversal::waiting(0, 0);
    for (std::size_t top = 1; top != 0;) {
        const std::uint64_t next = stack[--top];
        if (NearestTraversal::bound(next) > bound)
            continue;
        const std::uint32_t node = NearestTraversal::ref(next);
        if (tree.is_leaf(node)) {
            if constexpr (std::is_same_v<Best, NearestItems>) {
                best.offer({tree.item(node), squared_distance(point, tree.bounds(node))});
            } else {
                traversal.count_triangles<Counted>(1);
                best.offer(tree.item(node));
            }
            bound = scaled.above(best.worst());
            continue;
        }
        const auto child = [&](std::uint32_t i) {
            return NearestTraversal::waiting(scaled.below(squared_distance(point, tree.bounds(i))),
                                             i);
        };
        traversal.count<Counted>(2, top + 2);
        const auto [near, far] =
            std::minmax({child(right_of(tree, node)), child(left_of(tree, node))});
        stack[top++] = far;
        stack[top++] = near;
    }
}

} // namespace

#define X(name, L)                                                                                 \
    void traverse_regions(const L& layout, const RegionQueries& queries,                           \
                          RegionTraversal& traversal, std::size_t first, std::size_t last) {       \
        traversal.counted() ? answer<true>(layout, queries, traversal, first, last)                \
                            : answer<false>(layout, queries, traversal, first, last);              \
    }                                                                                              \
    void traverse_nearest(const L& layout, Vec3<float> point, NearestItems& best,                  \
                          NearestTraversal& traversal) {                                           \
        traversal.counted() ? search<true>(layout, point, best, traversal)                         \
                            : search<false>(layout, point, best, traversal);                       \
    }                                                                                              \
    void traverse_closest_point(const L& layout, Vec3<float> point, NearestSurface& best,          \
                                NearestTraversal& traversal) {                                     \
        traversal.counted() ? search<true>(layout, point, best, traversal)                         \
                            : search<false>(layout, point, best, traversal);                       \
    }
BOXWOOD_BINARY_TREES(X)
#undef X

} // namespace boxwood::detail
