#pragma once

#include "kernels/arithmetic/on_both.h"

#include <cmath>

namespace boxwood {

/// A point or direction of three components, scene units. Its arithmetic is inlined always: in a
/// large translation unit GCC 12 else calls a cross product, and kernels take a fifth longer.
template <class Real> struct Vec3 {
    Real x{}, y{}, z{};

    BOXWOOD_BOTH constexpr Real operator[](int axis) const {
        return axis == 0 ? x : axis == 1 ? y : z;
    }
    BOXWOOD_BOTH constexpr Real& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }

    constexpr bool operator==(const Vec3&) const = default;

    /// Component-wise conversion, rounded to nearest.
    template <class Other> BOXWOOD_BOTH constexpr explicit operator Vec3<Other>() const {
        return {static_cast<Other>(x), static_cast<Other>(y), static_cast<Other>(z)};
    }
};

template <class Real>
[[gnu::always_inline]] BOXWOOD_BOTH constexpr Vec3<Real> operator+(Vec3<Real> a, Vec3<Real> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
[[gnu::always_inline]] BOXWOOD_BOTH constexpr Vec3<Real> operator-(Vec3<Real> a, Vec3<Real> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
[[gnu::always_inline]] BOXWOOD_BOTH constexpr Vec3<Real> operator-(Vec3<Real> a) {
    return {-a.x, -a.y, -a.z};
}
template <class Real>
[[gnu::always_inline]] BOXWOOD_BOTH constexpr Vec3<Real> operator*(Vec3<Real> a, Real s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <class Real>
[[gnu::always_inline]] BOXWOOD_BOTH constexpr Vec3<Real> operator*(Real s, Vec3<Real> a) {
    return a * s;
}

template <class Real>
[[gnu::always_inline]] BOXWOOD_BOTH constexpr Real dot(Vec3<Real> a, Vec3<Real> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
[[gnu::always_inline]] BOXWOOD_BOTH constexpr Vec3<Real> cross(Vec3<Real> a, Vec3<Real> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real> [[gnu::always_inline]] inline Real length(Vec3<Real> a) {
    return std::sqrt(dot(a, a));
}

/// Component-wise minimum and maximum; where `b` is NaN the result is `a`.
template <class Real>
[[gnu::always_inline]] BOXWOOD_BOTH constexpr Vec3<Real> min(Vec3<Real> a, Vec3<Real> b) {
    return {b.x < a.x ? b.x : a.x, b.y < a.y ? b.y : a.y, b.z < a.z ? b.z : a.z};
}
template <class Real>
[[gnu::always_inline]] BOXWOOD_BOTH constexpr Vec3<Real> max(Vec3<Real> a, Vec3<Real> b) {
    return {a.x < b.x ? b.x : a.x, a.y < b.y ? b.y : a.y, a.z < b.z ? b.z : a.z};
}

template <class Real> BOXWOOD_BOTH bool is_finite(Vec3<Real> a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

} // namespace boxwood
