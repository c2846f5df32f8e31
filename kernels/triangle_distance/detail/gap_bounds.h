#pragma once

#include "kernels/triangle_distance/detail/one_lane.h"
#include "kernels/triangle_distance/detail/refined_bounds.h"

#include <cmath>

namespace boxwood::detail {

BOXWOOD_BOTH inline Vec3<double> abs(Vec3<double> v) {
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

BOXWOOD_BOTH inline bool tight(const DistanceBounds& b) { return b.lo >= b.hi * (1 - 0x1p-32); }

/// Bounds from a pair of points found in plain arithmetic (lo = 0 if they prove nothing).
/// Let x, y be the corners' differences from a's first, E_k the greatest |x_k| plus the greatest
/// |y_k|, n the offset. Every point of a and b is at least gap / |n| apart, gap = min n.x - max
/// n.y.
///   gap     a component of x or y has 1 rounding, its product 1, the sum 2, the subtraction 1:
///           5u sum |n_k| E_k, computed with 5 roundings; 6u covers them and what is O(u^2)
///   |n|     3 roundings under the root, which halves them, and the root's: 2.5u; with the
///           quotient and the last product below 5u: 8u
///   offset  (corner - corner) + two weighted edges - two weighted edges: at most 12u E_k (weights
///           sum to 1 at most, and the edges of b are at most twice its E_k apart); weights that
///           are off the triangle by rounding 6u E_k: 20u E_k with what is O(u^2)
BOXWOOD_BOTH inline DistanceBounds bounds_from(const one_lane::PointPair<double>& pair,
                                               const Triangle<double>& a,
                                               const Triangle<double>& b) {
    constexpr double u = 0x1p-53;
    constexpr double underflow = 0x1p-1060; // of all products below, and of coordinates scaled down
    const Vec3<double> n = pair.offset, x1 = a.b - a.a, x2 = a.c - a.a;
    const Vec3<double> y0 = b.a - a.a, y1 = b.b - a.a, y2 = b.c - a.a;
    const Vec3<double> extent = max(abs(x1), abs(x2)) + max(max(abs(y0), abs(y1)), abs(y2));
    const double squared = dot(n, n), length = std::sqrt(squared);
    const double hi =
        length * (1 + 6 * u) + (20 * u * (extent.x + extent.y + extent.z) + underflow);
    using one_lane::max, one_lane::min;
    const double near_a = min(min(dot(n, x1), dot(n, x2)), 0.0);
    const double near_b = max(max(dot(n, y0), dot(n, y1)), dot(n, y2));
    const double gap = (near_a - near_b) - (6 * u * dot(abs(n), extent) + underflow);
    const double lo = gap / length * (1 - 8 * u);
    // Below, squares underflow.
    return {squared > 0x1p-900 && lo > 0 ? lo : 0, hi, std::sqrt(pair.squared), pair.a, pair.b};
}

} // namespace boxwood::detail
