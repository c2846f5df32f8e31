#pragma once

#include "trees/tree.h"

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace boxwood::detail {

/// A box of FCL's or Coal's, whose corners are min_ and max_; the type of their numbers.
template <class Bounds>
using ScalarOf = std::remove_cvref_t<decltype(std::declval<const Bounds&>().min_[0])>;

/// A float box around bounds, for trees: two bounds that overlap have boxes that do. Box{} for
/// one that trees had better not hold: not a number somewhere, min > max, or far out as the bounds
/// of planes and half-spaces are. The test of the bounds themselves decides about those.
/// Doubles are rounded to nearest and then moved out by two ulps: quicker than to round outward.
template <class Bounds> Box box_around(const Bounds& bounds) {
    using S = ScalarOf<Bounds>;
    constexpr S far = S(1e18); // squares of floats as large do not overflow
    bool fits = true;
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        const S low = bounds.min_[axis], high = bounds.max_[axis];
        fits &= low >= -far && low <= high && high <= far;
        box.min[axis] = static_cast<float>(low);
        box.max[axis] = static_cast<float>(high);
        if constexpr (!std::is_same_v<S, float>) {
            constexpr float share = 0x1p-22f, min = std::numeric_limits<float>::min();
            box.min[axis] -= std::abs(box.min[axis]) * share + min;
            box.max[axis] += std::abs(box.max[axis]) * share + min;
        }
    }
    return fits ? box : Box{};
}

template <class Bounds> bool is_same(const Bounds& a, const Bounds& b) {
    bool same = true;
    for (int axis = 0; axis < 3; ++axis)
        same &= a.min_[axis] == b.min_[axis] && a.max_[axis] == b.max_[axis];
    return same;
}

/// AABB::overlap of FCL and Coal, of any bounds, without a call and without a branch: what is not a
/// number keeps nothing apart.
template <class Bounds> bool overlap(const Bounds& a, const Bounds& b) {
    bool apart = false;
    for (int axis = 0; axis < 3; ++axis)
        apart |= a.min_[axis] > b.max_[axis] || a.max_[axis] < b.min_[axis];
    return !apart;
}

/// Asks for the line of its first byte to be in the cache soon.
inline void prefetch(const void* object) {
#if defined(__GNUC__)
    __builtin_prefetch(object);
#else
    static_cast<void>(object);
#endif
}

} // namespace boxwood::detail
