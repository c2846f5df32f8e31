#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/vec3.h"

#include <concepts>
#include <cstdint>
#include <string_view>

namespace boxwood {

/// A point of a coordinate plane.
template <class Real> struct Point2 {
    Real x, y;

    constexpr bool operator==(const Point2&) const = default;
};

/// What a predicate answers, beside the signs -1, 0 and 1, if its bound does not decide.
inline constexpr int undecided = 2;

/// What decides triangle truth (`f32`, `f64`, `filtered`, `exact`), for points of P::Real:
///   orient3d(a, b, c, d): sign of (d - a) . ((b - a) x (c - a)), 1 if d sees a, b, c turn left
///   orient2d(a, b, c):    sign of (b - a) x (c - a), 1 if a, b, c turn left
/// `promise` is what a kernel keeps that uses nothing but these signs.
template <class P>
concept OrientationPredicates = requires(Vec3<typename P::Real> p, Point2<typename P::Real> q) {
    { P::orient3d(p, p, p, p) } -> std::same_as<int>;
    { P::orient2d(q, q, q) } -> std::same_as<int>;
    { P::name } -> std::convertible_to<std::string_view>;
    { P::summary } -> std::convertible_to<std::string_view>;
    { P::bound } -> std::convertible_to<std::string_view>;
    { P::cost } -> std::convertible_to<std::string_view>;
    { P::promise } -> std::convertible_to<Promise>;
    { P::tier } -> std::convertible_to<std::uint8_t>;
};

} // namespace boxwood
