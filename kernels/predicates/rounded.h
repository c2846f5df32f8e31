#pragma once

#include "kernels/predicates/orientation.h"

#include <type_traits>

namespace boxwood {

/// Determinants in plain float or double arithmetic. Exact while the products need at most 24 or 53
/// bits (integers up to 2^6 or 2^16 in size); else wrong signs are possible wherever the
/// determinant is near zero, also by underflow. Overflow to NaN and NaN input are undecided.
template <class R> struct Rounded {
    using Real = R;
    static constexpr bool single = std::is_same_v<Real, float>;
    static constexpr std::string_view name = single ? "f32" : "f64";
    static constexpr std::string_view summary =
        single ? "determinants in plain float" : "determinants in plain double";
    static constexpr std::string_view bound =
        "none: a sign is lost where |det| < 8u * permanent (Shewchuk 1997: 7u)";
    static constexpr std::string_view cost = "40 to 140 flops";
    static constexpr Promise promise = Promise::none;
    static constexpr std::uint8_t tier = 0;

    static int orient3d(Vec3<Real> a, Vec3<Real> b, Vec3<Real> c, Vec3<Real> d) {
        return sign(dot(d - a, cross(b - a, c - a)));
    }
    static int orient2d(Point2<Real> a, Point2<Real> b, Point2<Real> c) {
        return sign((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    }

  private:
    static int sign(Real x) { return x > 0 ? 1 : x < 0 ? -1 : x == 0 ? 0 : undecided; }
};

} // namespace boxwood
