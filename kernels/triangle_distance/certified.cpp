#include "kernels/triangle_distance/certified.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/detail/rescale.h"
#include "kernels/triangle_distance/detail/exact_distance.h"
#include "kernels/triangle_distance/detail/nearest_pair.h"
#include "kernels/triangle_distance/detail/refined_bounds.h"
#include "kernels/triangle_triangle/exact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace boxwood {
namespace {

using namespace detail;

using Search = NearestPairSearch<double, false>;
using Pair = one_lane::PointPair<double>;

constexpr double u = 0x1p-53;
constexpr double underflow = 0x1p-1060; ///< of all products below, and of coordinates scaled down

Vec3<double> abs(Vec3<double> v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

bool tight(const DistanceBounds& b) { return b.lo >= b.hi * (1 - 0x1p-32); }

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
DistanceBounds bounds_from(const Pair& pair, const Triangle<double>& a, const Triangle<double>& b) {
    const Vec3<double> n = pair.offset, x1 = a.b - a.a, x2 = a.c - a.a;
    const Vec3<double> y0 = b.a - a.a, y1 = b.b - a.a, y2 = b.c - a.a;
    const Vec3<double> extent = max(abs(x1), abs(x2)) + max(max(abs(y0), abs(y1)), abs(y2));
    const double squared = dot(n, n), length = std::sqrt(squared);
    const double hi =
        length * (1 + 6 * u) + (20 * u * (extent.x + extent.y + extent.z) + underflow);
    const double near_a = std::min(std::min(dot(n, x1), dot(n, x2)), 0.0);
    const double near_b = std::max(std::max(dot(n, y0), dot(n, y1)), dot(n, y2));
    const double gap = (near_a - near_b) - (6 * u * dot(abs(n), extent) + underflow);
    const double lo = gap / length * (1 - 8 * u);
    // Below, squares underflow.
    return {squared > 0x1p-900 && lo > 0 ? lo : 0, hi, std::sqrt(pair.squared), pair.a, pair.b};
}

Distance between(const DistanceBounds& b, std::uint8_t tier) {
    return {std::clamp(b.distance, b.lo, b.hi), b.lo, b.hi, b.point_a, b.point_b, tier};
}
DistanceBounds touching(const Pair& pair) { return {0, 0, 0, pair.a, pair.b}; }

/// x * 2^exponent, rounded down, or up.
double scaled_down(double x, int exponent) {
    const double y = std::ldexp(x, exponent);
    return std::ldexp(y, -exponent) > x ? std::nextafter(y, 0.0) : y;
}
double scaled_up(double x, int exponent) {
    const double y = std::ldexp(x, exponent);
    return std::ldexp(y, -exponent) < x ? std::nextafter(y, std::numeric_limits<double>::infinity())
                                        : y;
}

/// Near contact, or out of range of plain arithmetic: all at a size near 1.
[[gnu::noinline]] Distance look_closer(const Triangle<double>& a, const Triangle<double>& b) {
    const std::optional<int> size = size_exponent(std::array{a.a, a.b, a.c, b.a, b.b, b.c});
    if (!size)
        return no_distance();
    const int e = *size;
    const Triangle<double> ua = times_power_of_two(a, -e), ub = times_power_of_two(b, -e);
    Pair pair{0, {}, {ua.a.x, ua.a.y, ua.a.z}, {ub.a.x, ub.a.y, ub.a.z}};
    const bool found = Search::find(ua, ub, pair); // else all is one point
    DistanceBounds bounds = touching(pair);
    if (found && pair.squared > 0)
        bounds = bounds_from(pair, ua, ub);
    std::uint8_t tier = 0;
    if (!(bounds.lo > 0)) {
        tier = GuigueDevillersExact::intersect(a, b).answer == Answer::yes ? 1 : 2;
        bounds = touching(pair);
    } else if (!tight(bounds)) {
        tier = 2;
    }
    int scale = e;
    if (tier == 2) {
        bounds = refined_bounds(ua, ub);
        if (!tight(bounds)) {
            tier = 3;
            const Scaled d = exact_distance(a, b);
            bounds.lo = d.m * (1 - 0x1p-49);
            bounds.hi = d.m * (1 + 0x1p-49);
            bounds.distance = d.m;
            scale = d.exponent;
        }
    }
    bounds = {scaled_down(bounds.lo, scale), scaled_up(bounds.hi, scale),
              scaled_up(bounds.distance, scale), // not to 0
              times_power_of_two(bounds.point_a, e), times_power_of_two(bounds.point_b, e)};
    return between(bounds, tier);
}

Distance measure(const Triangle<double>& a, const Triangle<double>& b) {
    Pair pair;
    if (!Search::find(a, b, pair)) [[unlikely]]
        return look_closer(a, b);
    if (pair.squared > 0) [[likely]] {
        const DistanceBounds bounds = bounds_from(pair, a, b);
        if (tight(bounds)) [[likely]]
            return between(bounds, 0);
    } else if (GuigueDevillersExact::intersect(a, b).answer == Answer::yes) {
        return between(touching(pair), 1);
    }
    return look_closer(a, b);
}

} // namespace

Distance CertifiedDistance::distance(const Triangle<double>& a, const Triangle<double>& b) {
    return without_flushing([&] { return measure(a, b); });
}

} // namespace boxwood
