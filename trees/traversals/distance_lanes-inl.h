// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_DISTANCE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_DISTANCE_LANES_INL_H
#undef BOXWOOD_DISTANCE_LANES_INL_H
#else
#define BOXWOOD_DISTANCE_LANES_INL_H
#endif

#include "trees/layouts/detail/lanes-inl.h"
#include "trees/queries/box_distance.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// Floats, as many as a register holds lanes of the block.
template <class Block> using BoundTag = hwy::HWY_NAMESPACE::Rebind<float, LaneTag<Block>>;

template <class Block>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<LaneTag<Block>>
axis_distance(const Block& block, std::size_t i, std::size_t axis, float p, float scale) {
    namespace hn = hwy::HWY_NAMESPACE;
    using Real = typename Block::Real;
    const LaneTag<Block> d;
    const auto point = hn::Set(d, static_cast<Real>(p));
    const auto below = hn::Sub(load_plane(block, axis, i), point);
    const auto above = hn::Sub(point, load_plane(block, axis + 3, i));
    // The difference of two floats may overflow; the largest float is below it.
    const auto max_float = hn::Set(d, static_cast<Real>(std::numeric_limits<float>::max()));
    return hn::Mul(hn::Min(hn::Max(hn::Max(below, above), hn::Zero(d)), max_float),
                   hn::Set(d, static_cast<Real>(scale)));
}

/// Bounds from below of the squared distances of a point to lanes [i, i + Lanes(d)), scaled, and at
/// least 0. Where the lanes are of doubles they are rounded to floats first.
template <class Block>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<BoundTag<Block>>
distance_bounds(const Block& block, std::size_t i, Vec3<float> point, float scale) {
    namespace hn = hwy::HWY_NAMESPACE;
    const auto x = axis_distance(block, i, 0, point.x, scale);
    const auto y = axis_distance(block, i, 1, point.y, scale);
    const auto z = axis_distance(block, i, 2, point.z, scale);
    const auto sum = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    const BoundTag<Block> df;
    const auto floats = [&] {
        if constexpr (std::is_same_v<typename Block::Real, double>)
            return hn::DemoteTo(df, sum);
        else
            return sum;
    }();
    const auto smaller = hn::Sub(hn::Mul(floats, hn::Set(df, 1 - DistanceScale::share)),
                                 hn::Set(df, DistanceScale::min_error));
    return hn::Max(smaller, hn::Zero(df));
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
