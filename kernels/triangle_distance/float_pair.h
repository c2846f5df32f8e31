#pragma once

#include "kernels/arithmetic/detail/fixed_integer.h"
#include "kernels/triangle_distance/detail/gap_bounds.h"
#include "kernels/triangle_distance/detail/greatest_gap.h"
#include "kernels/triangle_triangle/float_pair.h"

#include <type_traits>

/// The distance of two triangles of floats, as a thread of a device finds it: by accuracy level, in
/// memory of fixed size. NaN and infinity: NaN, at each level.
namespace boxwood::float_pair {

/// lo <= distance <= hi.
struct Bounds {
    double lo, hi;
};

/// x * 2^exponent, rounded once; exponents below 300 in size.
template <class Real> BOXWOOD_BOTH Real scaled(Real x, int exponent) {
    const auto power = bits_as<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
    return static_cast<Real>(static_cast<double>(x) * power);
}
template <class Real> BOXWOOD_BOTH Triangle<Real> scaled(const Triangle<Real>& t, int exponent) {
    const auto point = [exponent](const Vec3<Real>& p) {
        return Vec3<Real>{scaled(p.x, exponent), scaled(p.y, exponent), scaled(p.z, exponent)};
    };
    return {point(t.a), point(t.b), point(t.c)};
}

/// NearestPairSearch<Real, false> with its corners in registers: the same operations, the same
/// points. False where it is out of range.
template <class Real> class NearestPair {
  public:
    using Vector = Vec3<Real>;
    using Points = detail::one_lane::PointPair<Real>;

    BOXWOOD_BOTH static bool find(const Triangle<Real>& a, const Triangle<Real>& b, Points& found) {
        using detail::one_lane::way_between;
        const Vector a1 = a.b - a.a, a2 = a.c - a.a, b1 = b.b - b.a, b2 = b.c - b.a;
        const Vector way = way_between(b.a - a.a, a1, a2, b1, b2);
        const int first = facing(way, a1, a2, b1, b2);
        return guess(first, a, b, found) || look_closer(a, b, first, found);
    }

  private:
    /// Which corners look away from the other triangle, of both, as one number.
    BOXWOOD_BOTH static int facing(const Vector& way, const Vector& a1, const Vector& a2,
                                   const Vector& b1, const Vector& b2) {
        const auto lower_of = [](Real x, Real y) {
            return y < detail::one_lane::min(x, Real(0)) ? 2 : x < 0 ? 1 : 0;
        };
        return 3 * lower_of(dot(way, a1), dot(way, a2)) + lower_of(-dot(way, b1), -dot(way, b2));
    }
    BOXWOOD_BOTH static Triangle<Real> turned(const Triangle<Real>& t, int first) {
        return first == 0   ? t
               : first == 1 ? Triangle<Real>{t.b, t.c, t.a}
                            : Triangle<Real>{t.c, t.a, t.b};
    }
    BOXWOOD_BOTH static bool guess(int corners, const Triangle<Real>& a, const Triangle<Real>& b,
                                   Points& found) {
        const Triangle<Real> ta = turned(a, corners / 3), tb = turned(b, corners % 3);
        return detail::one_lane::facing_edges<false>(ta.a, ta.b, ta.c, tb.a, tb.b, tb.c, found);
    }
    BOXWOOD_BOTH [[gnu::noinline]] static bool look_closer(Triangle<Real> a, Triangle<Real> b,
                                                           int before, Points& found) {
        using namespace detail::one_lane;
        const Vector way = -found.offset;
        const Shape<Real> shape_a(a.a, a.b, a.c), shape_b(b.a, b.b, b.c);
        const Facing<Real> pair(shape_a, shape_b);
        if (!pair.in_range())
            return false;
        Best<Real> best;
        if (!offer_crossing(pair, best)) {
            const int second = facing(way, a.b - a.a, a.c - a.a, b.b - b.a, b.c - b.a);
            if (second != before && guess(second, a, b, found))
                return true;
            offer_features<false>(pair, false, best);
        }
        found = best_pair(pair, best);
        return true;
    }
};

/// As size_exponent of kernels/detail/rescale.h, of finite corners that are floats.
template <class Real>
BOXWOOD_BOTH int size_exponent(const Triangle<Real>& a, const Triangle<Real>& b) {
    const Vec3<Real> points[6] = {a.a, a.b, a.c, b.a, b.b, b.c};
    Real largest = 0;
    for (const Vec3<Real>& p : points)
        for (int k = 0; k < 3; ++k)
            largest = detail::one_lane::max(largest, detail::size_of(p[k]));
    const bool halve = std::is_same_v<Real, float> && largest > Real(0x1.fffffep125f);
    const Real factor = halve ? Real(0.5) : Real(1);
    Real size = 0;
    for (const Vec3<Real>& p : points)
        for (int k = 0; k < 3; ++k)
            size =
                detail::one_lane::max(size, detail::size_of(p[k] * factor - points[0][k] * factor));
    const auto bits = bits_as<std::uint64_t>(static_cast<double>(size));
    return size == 0 ? 0 : static_cast<int>(bits >> 52) - 1023 + 2 + halve;
}

BOXWOOD_BOTH inline double not_a_number() { return bits_as<double>(std::uint64_t{0x7ff8} << 48); }

/// In plain arithmetic, no bound: the distances of FeaturesF32 or FeaturesF64, bit for bit.
template <class Real>
BOXWOOD_BOTH double plain_distance(const Triangle<float>& fa, const Triangle<float>& fb) {
    const auto as_real = [](const Triangle<float>& t) {
        using Point = Vec3<Real>;
        return Triangle<Real>{static_cast<Point>(t.a), static_cast<Point>(t.b),
                              static_cast<Point>(t.c)};
    };
    Triangle<Real> a = as_real(fa), b = as_real(fb);
    typename NearestPair<Real>::Points found{};
    int exponent = 0;
    if (!NearestPair<Real>::find(a, b, found)) {
        if (!is_finite(fa) || !is_finite(fb))
            return not_a_number();
        exponent = size_exponent(a, b);
        a = scaled(a, -exponent);
        b = scaled(b, -exponent);
        found.squared = 0; // where all is one point
        NearestPair<Real>::find(a, b, found);
    }
    return scaled(static_cast<double>(std::sqrt(found.squared)), exponent);
}

/// Proven bounds; `sure` if they are as CertifiedDistance promises: hi - lo <= 2^-32 hi.
BOXWOOD_BOTH inline Bounds certified_distance(const Triangle<float>& fa, const Triangle<float>& fb,
                                              bool& sure) {
    sure = is_finite(fa) && is_finite(fb);
    if (!sure)
        return {not_a_number(), not_a_number()};
    Triangle<double> a = widened(fa), b = widened(fb);
    NearestPair<double>::Points found{};
    int exponent = 0;
    bool is_found = NearestPair<double>::find(a, b, found);
    if (!is_found) {
        exponent = size_exponent(a, b);
        a = scaled(a, -exponent);
        b = scaled(b, -exponent);
        is_found = NearestPair<double>::find(a, b, found);
        if (!is_found) // all is one point
            return {0, 0};
    }
    // Seen to cross, but perhaps apart by less than rounding shows: at most as far as two corners.
    if (!(found.squared > 0)) {
        sure = false;
        const Vec3<double> n = a.a - b.a;
        return {0, scaled(std::sqrt(dot(n, n)) * (1 + 0x1p-50) + 0x1p-400, exponent)};
    }
    const detail::DistanceBounds bounds = detail::bounds_from(found, a, b);
    sure = detail::tight(bounds);
    return {scaled(bounds.lo, exponent), scaled(bounds.hi, exponent)};
}

/// All corners of two triangles as whole multiples of one power of two, 2^(low - 149), in
/// FixedInteger<words>: 1 if they are below 2^61 then, 5 for all finite floats (2^277). With k bits
/// in a coordinate, what GreatestGap makes of them is below 2^(k + 1), 2^(2k + 3), 2^(3k + 5) and
/// 2^(4k + 9): 1 to 4 times as long.
template <int words> struct WholeCorners {
    static constexpr int bits = words == 1 ? 61 : 277;
    detail::WholeVector<detail::FixedInteger<words>> at[6];

    /// Whether they fit, with `low` then.
    BOXWOOD_BOTH static bool holds(const Triangle<float>& a, const Triangle<float>& b, int& low) {
        const Vec3<float> points[6] = {a.a, a.b, a.c, b.a, b.b, b.c};
        int high = 0;
        low = 255;
        for (const Vec3<float>& p : points)
            for (int k = 0; k < 3; ++k)
                if (const detail::Binary32 x(p[k]); x.mantissa != 0) {
                    low = x.weight < low ? x.weight : low;
                    high = x.weight > high ? x.weight : high;
                }
        return high - low <= bits - 24;
    }
    BOXWOOD_BOTH WholeCorners(const Triangle<float>& a, const Triangle<float>& b, int low) {
        const Vec3<float> points[6] = {a.a, a.b, a.c, b.a, b.b, b.c};
        for (int i = 0; i < 6; ++i)
            for (int k = 0; k < 3; ++k) {
                const detail::Binary32 x(points[i][k]);
                detail::FixedInteger<words> size;
                if (x.mantissa != 0) {
                    const int shift = x.weight - low;
                    const auto wide = detail::UInt128{x.mantissa} << shift % 64;
                    for (int w = 0; w < words; ++w)
                        size.word[w] = w == shift / 64 ? static_cast<std::uint64_t>(wide)
                                       : w == shift / 64 + 1
                                           ? static_cast<std::uint64_t>(wide >> 64)
                                           : 0;
                }
                at[i].of[k] = x.negative ? detail::FixedInteger<words>{} - size : size;
            }
    }
};

/// 0 = lo = hi exactly where they touch, else hi - lo <= 2^-48 hi, of what WholeCorners<words> hold
/// (if not: false, and nothing is written).
template <int words>
BOXWOOD_BOTH bool exact_distance(const Triangle<float>& a, const Triangle<float>& b,
                                 Bounds& bounds) {
    int low = 0;
    if (!is_finite(a) || !is_finite(b) || !WholeCorners<words>::holds(a, b, low))
        return false;
    const WholeCorners<words> corners(a, b, low);
    const detail::Scaled gap =
        detail::GreatestGap<detail::FixedInteger<words>>(corners.at).distance();
    const double d = std::ldexp(gap.m, gap.exponent + low - 149);
    bounds = {d * (1 - 0x1p-49), d * (1 + 0x1p-49)};
    return true;
}

} // namespace boxwood::float_pair
