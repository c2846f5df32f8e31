#pragma once

#include "kernels/triangle_distance/distance_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace boxwood::detail {

/// What a distance kernel answers to NaN or infinity.
constexpr Distance no_distance() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan, {nan, nan, nan}, {nan, nan, nan}, 0};
}

/// The exponent e for which what spans the points, times 2^-e, is between 1/4 and 1 along its
/// longest axis; 0 if they are all one point. Nothing if one of them is not finite.
template <class Real, std::size_t n>
std::optional<int> size_exponent(const std::array<Vec3<Real>, n>& points) {
    Real largest = 0;
    for (const Vec3<Real>& p : points) {
        if (!is_finite(p))
            return std::nullopt;
        for (int k = 0; k < 3; ++k)
            largest = std::max(largest, std::abs(p[k]));
    }
    // Differences of the largest numbers would overflow; those of halved denormals would vanish.
    const bool halve = largest > std::numeric_limits<Real>::max() / 4;
    const Real factor = halve ? Real(0.5) : Real(1);
    Real size = 0;
    for (const Vec3<Real>& p : points)
        for (int k = 0; k < 3; ++k)
            size = std::max(size, std::abs(p[k] * factor - points[0][k] * factor));
    return size == 0 ? 0 : std::ilogb(size) + 2 + halve;
}

template <class Real> Vec3<Real> times_power_of_two(Vec3<Real> p, int exponent) {
    return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}
template <class Real> Triangle<Real> times_power_of_two(const Triangle<Real>& t, int exponent) {
    return {times_power_of_two(t.a, exponent), times_power_of_two(t.b, exponent),
            times_power_of_two(t.c, exponent)};
}
template <class Real> Segment<Real> times_power_of_two(const Segment<Real>& s, int exponent) {
    return {times_power_of_two(s.a, exponent), times_power_of_two(s.b, exponent)};
}

/// measure(a, b) of the two at a size near 1, scaled back: for those so large or small that
/// products of their lengths would leave the range of Real. `points` are the corners of both.
/// Scaling down loses only what is 2^-100 of the size or less.
template <class Real, std::size_t n, class A, class B, class Measure>
Distance at_unit_size(const std::array<Vec3<Real>, n>& points, const A& a, const B& b,
                      Measure measure) {
    const std::optional<int> exponent = size_exponent(points);
    if (!exponent)
        return no_distance();
    const int e = *exponent;
    const Distance d = measure(times_power_of_two(a, -e), times_power_of_two(b, -e));
    return {std::ldexp(d.distance, e),
            std::ldexp(d.lo, e),
            std::ldexp(d.hi, e),
            times_power_of_two(d.point_a, e),
            times_power_of_two(d.point_b, e),
            d.tier};
}

} // namespace boxwood::detail
