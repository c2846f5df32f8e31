// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide_nearest.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/layouts/packed.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"
#include "trees/traversals/compress-inl.h"
#include "trees/traversals/distance_lanes-inl.h"
#include "trees/traversals/nearest_traversal.h"
#include "trees/traversals/triangle_lanes-inl.h"

#include <bit>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Of the lanes of a block those whose bound, of bounds_at(i), is at most `bound`, as
/// NearestTraversal::waiting of their references, or of their numbers; the nearest last. Returns
/// how many. Up to a register is overwritten behind them.
template <bool Numbers, class Block, class BoundsAt>
HWY_INLINE std::size_t append_near(const Block& block, const BoundsAt& bounds_at, float bound,
                                   std::uint64_t* to) {
    const BoundTag<Block> df;
    const hn::RebindToUnsigned<decltype(df)> du;
    std::size_t n = 0;
    for (std::size_t i = 0; i < Block::width; i += hn::Lanes(df)) {
        const auto bounds = bounds_at(i);
        const auto hits = hn::RebindMask(du, hn::Le(bounds, hn::Set(df, bound)));
        const auto refs =
            Numbers ? hn::Iota(du, static_cast<std::uint32_t>(i)) : load_refs(block, i);
        hn::StoreInterleaved2(compressed(du, refs, hits),
                              compressed(du, hn::BitCast(du, bounds), hits), du,
                              reinterpret_cast<std::uint32_t*>(to + n));
        n += hn::CountTrue(du, hits);
    }
    for (std::size_t i = 1; i < n; ++i) {
        const std::uint64_t x = to[i];
        std::size_t j = i;
        for (; j > 0 && to[j - 1] < x; --j)
            to[j] = to[j - 1];
        to[j] = x;
    }
    return n;
}

/// Bounds of the lanes of a block; NaN of those without anything.
template <class Block>
HWY_INLINE hn::Vec<BoundTag<Block>> used_bounds(const Block& block, std::size_t i,
                                                Vec3<float> point, float scale) {
    const BoundTag<Block> df;
    return hn::IfThenElse(used_lanes(df, block, i), distance_bounds(block, i, point, scale),
                          hn::Set(df, std::numeric_limits<float>::quiet_NaN()));
}

/// The reference of the nearest lane. to: the bounds of all others, NaN for itself.
template <class Block>
HWY_INLINE std::uint32_t nearest_lane(const Block& block, Vec3<float> point, float scale,
                                      float* to) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const BoundTag<Block> df;
    std::size_t lane = 0;
    float min_bound = inf;
    for (std::size_t i = 0; i < Block::width; i += hn::Lanes(df)) {
        const auto bounds = used_bounds(block, i, point, scale);
        hn::Store(bounds, df, to + i);
        const auto known = hn::IfThenElse(hn::Eq(bounds, bounds), bounds, hn::Set(df, inf));
        const float here = hn::GetLane(hn::MinOfLanes(df, known));
        if (here < min_bound) {
            min_bound = here;
            lane = static_cast<std::size_t>(
                std::countr_zero(mask_bits(df, hn::Eq(bounds, hn::Set(df, here)), i)));
        }
    }
    to[lane] = std::numeric_limits<float>::quiet_NaN();
    return block.ref[lane];
}

/// What a search looks for, bounded by what it has found.
struct Goal {
    Vec3<float> point;
    DistanceScale scaled;
    float bound = std::numeric_limits<float>::infinity();
};

/// The items of a leaf, nearest first.
template <bool Counted, class Leaf>
HWY_INLINE void offer_all(const Leaf& leaf, Goal& goal, NearestItems& best, NearestTraversal&) {
    alignas(64) std::uint64_t lanes[2 * RegionTraversal::spare];
    const std::size_t n = append_near<true>(
        leaf,
        [&](std::size_t i) HWY_ATTR { return used_bounds(leaf, i, goal.point, goal.scaled.scale); },
        goal.bound, lanes);
    for (std::size_t i = n; i-- > 0 && NearestTraversal::bound(lanes[i]) <= goal.bound;) {
        const std::uint32_t lane = NearestTraversal::ref(lanes[i]);
        best.offer({leaf.ref[lane], squared_distance(goal.point, leaf.lane(lane))});
        goal.bound = goal.scaled.above(best.worst());
    }
}

/// The triangles of a leaf: all that are near by their boxes are bounded together in floats, and
/// computed in doubles if they may still be nearer than what was found, the nearest first.
template <bool Counted, class Leaf>
HWY_INLINE void offer_all(const Leaf& leaf, Goal& goal, NearestSurface& best,
                          NearestTraversal& traversal) {
    const BoundTag<Leaf> df;
    const float scale = goal.scaled.scale;
    std::uint32_t near = 0;
    for (std::size_t i = 0; i < Leaf::width; i += hn::Lanes(df))
        near |= mask_bits(
            df,
            hn::And(hn::Le(distance_bounds(leaf, i, goal.point, scale), hn::Set(df, goal.bound)),
                    used_lanes(df, leaf, i)),
            i);
    if (near == 0)
        return;
    SeenTriangles seen{}; // denormals in unused lanes would cost ten times the whole search
    std::uint32_t items[SeenTriangles::max];
    std::size_t n = 0;
    for (; near != 0; near &= near - 1) {
        items[n] = leaf.ref[static_cast<std::size_t>(std::countr_zero(near))];
        seen.set(n, best.triangle(items[n]), goal.point, scale);
        ++n;
    }
    traversal.template count_triangles<Counted>(n);
    const hn::CappedTag<float, SeenTriangles::max> d;
    alignas(64) float bounds[SeenTriangles::max];
    for (std::size_t i = 0; i < n; i += hn::Lanes(d))
        hn::Store(triangle_bounds(d, seen, i), d, bounds + i);
    const std::size_t first =
        static_cast<std::size_t>(std::min_element(bounds, bounds + n) - bounds);
    const auto offer = [&](std::size_t i) {
        if (bounds[i] > goal.bound)
            return;
        best.offer(items[i]);
        goal.bound = goal.scaled.above(best.worst());
    };
    offer(first);
    for (std::size_t i = 0; i < n; ++i)
        if (i != first)
            offer(i);
}

/// All that may be as near as the best so far: first a way down to the nearest leaf, whose bound
/// leaves little of what was passed on the way, then that, the lowest first, and of each block the
/// nearest first.
template <bool Counted, class L, class Best>
HWY_INLINE void search(const L& tree, Vec3<float> point, Best& best, NearestTraversal& traversal) {
    Goal goal{point, DistanceScale(point, tree.bounds())};
    const float scale = goal.scaled.scale;
    const auto open_leaf = [&](std::uint32_t ref, std::size_t waiting) HWY_ATTR {
        traversal.template count<Counted>(L::width, waiting);
        offer_all<Counted>(tree.leaf(ref), goal, best, traversal);
    };
    constexpr std::size_t longest_way = 24; // what is below, is searched as the rest
    alignas(64) float passed[longest_way][L::width];
    std::uint32_t way[longest_way];
    std::size_t length = 0;
    std::uint32_t end = tree.root();
    for (; !L::is_leaf(end) && length < longest_way; ++length) {
        way[length] = end;
        end = nearest_lane(tree.block(end), point, scale, passed[length]);
        traversal.template count<Counted>(L::width, 0);
    }
    const bool is_at_leaf = L::is_leaf(end);
    if (is_at_leaf)
        open_leaf(end, 0);

    std::uint64_t* const stack = traversal.stack();
    std::size_t top = 0;
    for (std::size_t i = 0; i < length; ++i) {
        const auto& block = tree.block(way[i]);
        const BoundTag<std::remove_cvref_t<decltype(block)>> df;
        top += append_near<false>(
            block, [&](std::size_t j) HWY_ATTR { return hn::Load(df, passed[i] + j); }, goal.bound,
            stack + top);
    }
    if (!is_at_leaf)
        stack[top++] = NearestTraversal::waiting(0, end);
    while (top != 0) {
        const std::uint64_t next = stack[--top];
        const std::uint32_t ref = NearestTraversal::ref(next);
        if (NearestTraversal::bound(next) > goal.bound)
            continue;
        if (L::is_leaf(ref)) {
            open_leaf(ref, top);
        } else {
            const auto& block = tree.block(ref);
            top += append_near<false>(
                block, [&](std::size_t i) HWY_ATTR { return used_bounds(block, i, point, scale); },
                goal.bound, stack + top);
            traversal.template count<Counted>(L::width, top);
        }
    }
}

#define X(name, L)                                                                                 \
    void nearest_##name(const L& tree, Vec3<float> point, NearestItems& best,                      \
                        NearestTraversal& traversal) {                                             \
        traversal.counted() ? search<true>(tree, point, best, traversal)                           \
                            : search<false>(tree, point, best, traversal);                         \
    }                                                                                              \
    void surface_##name(const L& tree, Vec3<float> point, NearestSurface& best,                    \
                        NearestTraversal& traversal) {                                             \
        traversal.counted() ? search<true>(tree, point, best, traversal)                           \
                            : search<false>(tree, point, best, traversal);                         \
    }
BOXWOOD_LANE_LAYOUTS(X)
#undef X

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {

#define X(name, L)                                                                                 \
    HWY_EXPORT(nearest_##name);                                                                    \
    void traverse_nearest(const L& tree, Vec3<float> point, NearestItems& best,                    \
                          NearestTraversal& traversal) {                                           \
        HWY_DYNAMIC_DISPATCH(nearest_##name)(tree, point, best, traversal);                        \
    }                                                                                              \
    HWY_EXPORT(surface_##name);                                                                    \
    void traverse_closest_point(const L& tree, Vec3<float> point, NearestSurface& best,            \
                                NearestTraversal& traversal) {                                     \
        HWY_DYNAMIC_DISPATCH(surface_##name)(tree, point, best, traversal);                        \
    }
BOXWOOD_LANE_LAYOUTS(X)
#undef X

} // namespace boxwood::detail
#endif
