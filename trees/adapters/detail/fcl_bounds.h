#pragma once

#include "trees/tree.h"

#include <fcl/math/bv/AABB.h>

#include <cmath>
#include <limits>
#include <type_traits>

namespace boxwood::detail {

/// A float box around FCL's, for trees: two of FCL's that overlap have boxes that do. Box{} for
/// one that trees had better not hold: not a number somewhere, min > max, or far out as the bounds
/// of planes and half-spaces are. FCL's own test decides about those.
/// Doubles are rounded to nearest and then moved out by two ulps: quicker than to round outward.
template <class S> Box box_around(const fcl::AABB<S>& bounds) {
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

template <class S> bool is_same(const fcl::AABB<S>& a, const fcl::AABB<S>& b) {
    bool same = true;
    for (int axis = 0; axis < 3; ++axis)
        same &= a.min_[axis] == b.min_[axis] && a.max_[axis] == b.max_[axis];
    return same;
}

/// fcl::AABB::overlap, of any bounds, without a call and without a branch: what is not a number
/// keeps nothing apart.
template <class S> bool overlap(const fcl::AABB<S>& a, const fcl::AABB<S>& b) {
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
