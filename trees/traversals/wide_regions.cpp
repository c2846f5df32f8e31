// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide_regions.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/layouts/packed.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"
#include "trees/traversals/compress-inl.h"
#include "trees/traversals/distance_lanes-inl.h"
#include "trees/traversals/region_traversal.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Appends the references of the lanes in a mask; stores whole registers.
template <class Block>
HWY_INLINE std::size_t append_refs(const Block& block, std::size_t i,
                                   hn::Mask<LaneTag<Block>> lanes, std::uint32_t* to) {
    const RefTag<Block> du;
    hn::StoreU(compressed(du, load_refs(block, i), ref_mask<Block>(lanes)), du, to);
    return hn::CountTrue(LaneTag<Block>(), lanes);
}

/// Of a box, which may be a point: the lanes that overlap it.
template <class Real> struct BoxRegion {
    Aabb<Real> box;

    template <class Block>
    HWY_INLINE std::size_t append(const Block& block, std::uint32_t* to) const {
        std::size_t n = 0;
        for (std::size_t i = 0; i < Block::width; i += hn::Lanes(LaneTag<Block>()))
            n += append_refs(block, i, overlap_mask(block, i, box), to + n);
        return n;
    }
    template <class Block>
    HWY_INLINE std::size_t append_items(const Block& block, std::uint32_t* to) const {
        return append(block, to);
    }
};

/// Of a ball: inner lanes by floats, those of a leaf that may meet it again in doubles.
struct Ball {
    Vec3<float> centre;
    double squared_radius;
    /// Squares, scaled: what is bounded from below by more than `bound` is outside; by less than
    /// `sure_bound`, inside.
    float scale, bound, sure_bound;

    template <class Real>
    Ball(const Sphere<float>& ball, const Aabb<Real>& bounds) : centre(ball.centre) {
        const double radius = static_cast<double>(ball.radius);
        squared_radius = radius * radius; // exact: 48 bits
        const DistanceScale scaled(centre, bounds);
        scale = scaled.scale;
        bound = scaled.above(squared_radius);
        // A bound b is of a square below (b + min_error) * (1 + 2 share); min_error again where it
        // underflows.
        sure_bound = scaled.below(squared_radius) * (1 - 4 * DistanceScale::share) -
                     4 * DistanceScale::min_error;
    }

    template <class Block>
    HWY_INLINE std::size_t append(const Block& block, std::uint32_t* to) const {
        const BoundTag<Block> df;
        const RefTag<Block> du;
        std::size_t n = 0;
        for (std::size_t i = 0; i < Block::width; i += hn::Lanes(df)) {
            const auto near =
                hn::And(hn::Le(distance_bounds(block, i, centre, scale), hn::Set(df, bound)),
                        used_lanes(df, block, i));
            const auto hits = hn::RebindMask(du, near);
            hn::StoreU(compressed(du, load_refs(block, i), hits), du, to + n);
            n += hn::CountTrue(du, hits);
        }
        return n;
    }
    /// What is inside by more than rounding is taken as it is, the others are computed.
    template <class Block>
    HWY_INLINE std::size_t append_items(const Block& block, std::uint32_t* to) const {
        const BoundTag<Block> df;
        const RefTag<Block> du;
        std::size_t n = 0;
        for (std::size_t i = 0; i < Block::width; i += hn::Lanes(df)) {
            const auto bounds = distance_bounds(block, i, centre, scale);
            const auto used = used_lanes(df, block, i);
            const auto sure = hn::And(hn::Lt(bounds, hn::Set(df, sure_bound)), used);
            const auto near = hn::And(hn::Le(bounds, hn::Set(df, bound)), used);
            const auto hits = hn::RebindMask(du, sure);
            hn::StoreU(compressed(du, load_refs(block, i), hits), du, to + n);
            n += hn::CountTrue(du, hits);
            for (std::uint32_t bits = mask_bits(df, hn::AndNot(sure, near), i); bits != 0;
                 bits &= bits - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
                to[n] = block.ref[lane];
                n += squared_distance(centre, block.lane(lane)) <= squared_radius;
            }
        }
        return n;
    }
};

/// Sorts the items of one query, all different; there is room for a register behind them. Short
/// lists by counting for each how many are below it: no branch depends on them.
HWY_INLINE void sort_items(std::span<std::uint32_t> items) {
    constexpr std::size_t max_short = 64;
    const std::size_t n = items.size();
    if (n < 2)
        return;
    if (n > max_short) {
        std::ranges::sort(items);
        return;
    }
    const hn::CappedTag<std::int32_t, 16> di; // items are below 2^31
    alignas(64) std::int32_t sorted[max_short];
    alignas(64) std::int32_t rank[16];
    const auto* in = reinterpret_cast<const std::int32_t*>(items.data());
    for (std::size_t i = 0; i < n; i += hn::Lanes(di)) {
        const auto v = hn::LoadU(di, in + i);
        auto below = hn::Zero(di);
        for (std::size_t j = 0; j < n; ++j) // a true lane is -1
            below = hn::Sub(below, hn::VecFromMask(di, hn::Lt(hn::Set(di, in[j]), v)));
        hn::Store(below, di, rank);
        for (std::size_t k = 0; k < std::min(hn::Lanes(di), n - i); ++k)
            sorted[rank[k]] = in[i + k];
    }
    std::copy_n(reinterpret_cast<const std::uint32_t*>(sorted), n, items.data());
}

/// All items of one region, into the traversal.
template <bool Counted, class L, class Region>
HWY_INLINE void collect_region(const L& tree, const Region& region, RegionTraversal& traversal) {
    std::uint32_t* const stack = traversal.stack();
    stack[0] = tree.root();
    for (std::size_t top = 1; top != 0;) {
        const std::uint32_t ref = stack[--top];
        if (L::is_leaf(ref)) {
            traversal.found(region.append_items(tree.leaf(ref), traversal.items_to()));
        } else {
            top += region.append(tree.block(ref), stack + top);
        }
        traversal.template count<Counted>(L::width, top);
    }
}

template <bool Counted, class L>
void answer(const L& tree, const RegionQueries& queries, RegionTraversal& traversal,
            std::size_t first, std::size_t last) {
    using Real = typename L::Real;
    const auto each = [&](const auto& regions, const auto& collect) HWY_ATTR {
        for (std::size_t i = first; i < last; ++i) {
            collect(regions[i]);
            sort_items(traversal.items());
            if (!traversal.answer(static_cast<std::uint32_t>(i)))
                return;
        }
    };
    const auto box = [&](const auto& region) HWY_ATTR {
        if (const auto b = finite_region(region))
            collect_region<Counted>(tree, BoxRegion<Real>{{Vec3<Real>(b->min), Vec3<Real>(b->max)}},
                                    traversal);
    };
    if (!queries.points.empty())
        each(queries.points, box);
    else if (!queries.boxes.empty())
        each(queries.boxes, box);
    else
        each(queries.spheres, [&](const Sphere<float>& ball) HWY_ATTR {
            if (is_region(ball))
                collect_region<Counted>(tree, Ball(ball, tree.bounds()), traversal);
        });
}

#define X(name, L)                                                                                 \
    void regions_##name(const L& tree, const RegionQueries& queries, RegionTraversal& traversal,   \
                        std::size_t first, std::size_t last) {                                     \
        traversal.counted() ? answer<true>(tree, queries, traversal, first, last)                  \
                            : answer<false>(tree, queries, traversal, first, last);                \
    }
BOXWOOD_LANE_LAYOUTS(X)
#undef X

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {

#define X(name, L)                                                                                 \
    HWY_EXPORT(regions_##name);                                                                    \
    void traverse_regions(const L& tree, const RegionQueries& queries, RegionTraversal& traversal, \
                          std::size_t first, std::size_t last) {                                   \
        HWY_DYNAMIC_DISPATCH(regions_##name)(tree, queries, traversal, first, last);               \
    }
BOXWOOD_LANE_LAYOUTS(X)
#undef X

} // namespace boxwood::detail
#endif
