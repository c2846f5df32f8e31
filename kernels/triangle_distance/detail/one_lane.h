#pragma once

#include <hwy/base.h>

#include "kernels/primitives/vec3.h"

#include <cmath>
#include <concepts>

/// The features of two triangles and the nearest among them, for one pair: V is float or double.
namespace boxwood::detail::one_lane {

/// What the arithmetic of nearest_features can take, of a type of numbers.
/// margin:            16u, of products of lengths
/// noise:             (8u)^2, of squared heights
/// rounding:          (32u)^2: two points are the same if (distance / size)^2 is not above
/// sliver:            the normal of a triangle is mostly rounding if its angle's sin^2 is not above
/// sine_squared:      lines are parallel below it
/// shortest_squared:  edges are points below it, as (length / size)^2
/// min_normal:        divides in place of 0
/// smallest, largest: size_squared for which no product of six lengths leaves the range
template <class V> struct Limits;
template <> struct Limits<double> {
    static constexpr double margin = 0x1p-49, noise = 0x1p-100, rounding = 0x1p-96,
                            sliver = 0x1p-40, sine_squared = 0x1p-200, shortest_squared = 0x1p-200,
                            min_normal = 0x1p-1022, smallest = 0x1p-120, largest = 0x1p120;
};
template <> struct Limits<float> {
    static constexpr double margin = 0x1p-20, noise = 0x1p-42, rounding = 0x1p-38, sliver = 0x1p-20,
                            sine_squared = 0x1p-40, shortest_squared = 0x1p-50,
                            min_normal = 0x1p-126, smallest = 0x1p-12, largest = 0x1p40;
};

#define BOXWOOD_LANE BOXWOOD_BOTH HWY_INLINE

template <class V> BOXWOOD_LANE constexpr V constant(double x) { return static_cast<V>(x); }
template <std::floating_point V> BOXWOOD_LANE V select(bool m, V x, V y) { return m ? x : y; }
template <std::floating_point V> BOXWOOD_LANE V min(V x, V y) { return x < y ? x : y; }
template <std::floating_point V> BOXWOOD_LANE V max(V x, V y) { return y < x ? x : y; }
template <std::floating_point V> BOXWOOD_LANE V abs(V x) { return std::abs(x); }
BOXWOOD_LANE bool both(bool m, bool n) { return m && n; }
BOXWOOD_LANE bool either(bool m, bool n) { return m || n; }
BOXWOOD_LANE bool same(bool m, bool n) { return m == n; }
BOXWOOD_LANE bool negation(bool m) { return !m; }
BOXWOOD_LANE bool any(bool m) { return m; }
BOXWOOD_LANE bool all(bool m) { return m; }

/// 1 / x of three positive numbers. Doubles by one division, as a batch does them.
BOXWOOD_LANE void reciprocals(double (&x)[3]) {
    const double p = x[0] * x[1], inverse = 1 / (p * x[2]), q = inverse * x[2];
    x[2] = inverse * p;
    const double x0 = x[0];
    x[0] = q * x[1];
    x[1] = q * x0;
}
BOXWOOD_LANE void reciprocals(float (&x)[3]) {
    for (float& each : x)
        each = 1 / each;
}

template <class V> using LaneVec3 = Vec3<V>;

#include "kernels/triangle_distance/detail/nearest_features-inl.h"

#undef BOXWOOD_LANE

} // namespace boxwood::detail::one_lane
