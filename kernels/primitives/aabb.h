#pragma once

#include "kernels/arithmetic/on_both.h"
#include "kernels/primitives/vec3.h"

#include <limits>

namespace boxwood {

/// A closed axis-aligned box: every point p with min <= p <= max, scene units.
/// Flat boxes (min == max on an axis) hold points and overlap like any other.
/// The empty box (min = +inf, max = -inf, the default) overlaps nothing and is the identity of
/// `merge`. A box with NaN overlaps nothing; builders refuse it (see `is_valid`).
template <class Real> struct Aabb {
    static constexpr Real inf = std::numeric_limits<Real>::infinity();

    Vec3<Real> min{inf, inf, inf};
    Vec3<Real> max{-inf, -inf, -inf};

    constexpr bool operator==(const Aabb&) const = default;

    /// Each number to nearest. A float box that holds one of doubles: round_outward.
    template <class Other> BOXWOOD_BOTH constexpr explicit operator Aabb<Other>() const {
        return {static_cast<Vec3<Other>>(min), static_cast<Vec3<Other>>(max)};
    }

    BOXWOOD_BOTH constexpr bool is_empty() const {
        return min.x > max.x || min.y > max.y || min.z > max.z;
    }

    /// What a builder accepts: all six numbers finite and min <= max on every axis.
    bool is_valid() const {
        return is_finite(min) && is_finite(max) && min.x <= max.x && min.y <= max.y &&
               min.z <= max.z;
    }

    BOXWOOD_BOTH constexpr void extend(Vec3<Real> p) {
        min = boxwood::min(min, p);
        max = boxwood::max(max, p);
    }
    BOXWOOD_BOTH constexpr void extend(const Aabb& b) {
        min = boxwood::min(min, b.min);
        max = boxwood::max(max, b.max);
    }

    BOXWOOD_BOTH constexpr bool contains(Vec3<Real> p) const {
        return min.x <= p.x && p.x <= max.x && min.y <= p.y && p.y <= max.y && min.z <= p.z &&
               p.z <= max.z;
    }
    BOXWOOD_BOTH constexpr bool contains(const Aabb& b) const {
        return min.x <= b.min.x && b.max.x <= max.x && min.y <= b.min.y && b.max.y <= max.y &&
               min.z <= b.min.z && b.max.z <= max.z;
    }

    /// Half of the surface area, in double so that no pair of finite floats overflows; 0 if empty.
    BOXWOOD_BOTH constexpr double half_area() const {
        if (is_empty())
            return 0;
        const double x = static_cast<double>(max.x) - static_cast<double>(min.x);
        const double y = static_cast<double>(max.y) - static_cast<double>(min.y);
        const double z = static_cast<double>(max.z) - static_cast<double>(min.z);
        return x * y + y * z + z * x;
    }
};

template <class Real> BOXWOOD_BOTH constexpr Aabb<Real> merge(Aabb<Real> a, const Aabb<Real>& b) {
    a.extend(b);
    return a;
}

/// True if the closed boxes share a point. Exact: comparisons only.
template <class Real>
BOXWOOD_BOTH constexpr bool overlaps(const Aabb<Real>& a, const Aabb<Real>& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
}

} // namespace boxwood
