#include "kernels/triangle_distance/certified.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/detail/rescale.h"
#include "kernels/triangle_distance/detail/exact_distance.h"
#include "kernels/triangle_distance/detail/gap_bounds.h"
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
