#pragma once

#include "kernels/arithmetic/float_mode.h"
#include "kernels/triangle_triangle/detail/sat_axes.h"
#include "kernels/triangle_triangle/triangle_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace boxwood {

/// Separating axes with proven margins: `no` if the gap along one of them exceeds what rounding
/// can fake, `yes` if along all that matter the overlap does; else `maybe`: where the two nearly
/// touch, are coplanar and overlap, or one is degenerate and touches. Works at every scale, and in
/// any mode of flushing. Source: numerics of Shewchuk 1997, applied to sat_axes.h.
struct SatCertified {
    using Real = double;
    static constexpr std::string_view name = "sat_certified";
    static constexpr KernelInfo info{
        "triangle_triangle",
        name,
        "separating axes (1996) whose gaps and overlaps must exceed their error bounds",
        Promise::certified,
        "gap > 9u sum |n||extent|, overlap > 450u (product of extents); derived in "
        "triangle_triangle/sat_certified.h",
        "about 800 flops"};

    static Decision intersect(const Triangle<double>& a, const Triangle<double>& b) {
        for (const Triangle<double>* t : {&a, &b})
            if (!is_finite(t->a) || !is_finite(t->b) || !is_finite(t->c))
                return {Answer::maybe, 0};
        return without_flushing([&] { return Decision{at_any_scale(a, b), 0}; });
    }

  private:
    // Let u = 2^-53, w the exact corners as seen from a.a, W the computed ones, m the largest |W|
    // per axis.
    //
    // Gap along an axis n, which is taken as exact: a computed n.W has passed 4 roundings
    // (difference, product, two sums), so that it's off by less than 4.01u S, S = sum |n_k| m_k;
    // two of them by less than 8.02u S. 9u S leaves room for the rounding of S and of the gap.
    //
    // Overlap along n = e x f of exact edges, |e|, |f| <= 2m: a computed n.W has passed 8 roundings
    // (three differences, product, minor, product, two sums) in each of 6 products of at most 4 mx
    // my mz: it's off by less than 192.1u mx my mz; two of them and the rounding of their
    // difference, at most 48 mx my mz, by less than 433u mx my mz. If both normals and all 9
    // crosses overlap thus, the exact axes do: no normal is zero, the planes aren't parallel, and
    // those 11 axes suffice.
    //
    // Coordinates are within [2^-200, 2^200] or scaled to [1, 2] (which may cost the small ones
    // 2^-1075), so nothing overflows. Underflow adds at most 2^-1060 to a gap (of axes up to 2^10
    // where it was scaled, else of products alone) and 2^-860 to an overlap.
    static constexpr double u = std::numeric_limits<double>::epsilon() / 2;
    static constexpr double gap_bound = 9 * u, gap_underflow = 0x1p-1000;
    static constexpr double overlap_bound = 450 * u, overlap_underflow = 0x1p-800;
    static constexpr double min_size = 0x1p-200, max_size = 0x1p200;

    static Answer at_any_scale(const Triangle<double>& a, const Triangle<double>& b) {
        const auto larger = [](const Vec3<double>& p, const Vec3<double>& q) {
            return max(p, Vec3<double>{std::abs(q.x), std::abs(q.y), std::abs(q.z)});
        };
        Vec3<double> extent{};
        for (const Triangle<double>* t : {&a, &b})
            extent = larger(larger(larger(extent, t->a), t->b), t->c);
        const double size = std::max({extent.x, extent.y, extent.z});
        if (size == 0 || (size >= min_size && size <= max_size))
            return at_this_scale(a, b);
        const int exponent = -std::ilogb(size);
        const auto scaled = [&](const Triangle<double>& t) {
            const auto point = [&](const Vec3<double>& p) {
                return Vec3<double>{std::scalbn(p.x, exponent), std::scalbn(p.y, exponent),
                                    std::scalbn(p.z, exponent)};
            };
            return Triangle<double>{point(t.a), point(t.b), point(t.c)};
        };
        return at_this_scale(scaled(a), scaled(b));
    }

    static Answer at_this_scale(const Triangle<double>& a, const Triangle<double>& b) {
        const detail::SatPair pair(a, b);
        const auto extent = [&](int k) {
            return std::max({std::abs(pair.a[1][k]), std::abs(pair.a[2][k]), std::abs(pair.b[0][k]),
                             std::abs(pair.b[1][k]), std::abs(pair.b[2][k])});
        };
        const double mx = extent(0), my = extent(1), mz = extent(2);
        const double clear = overlap_bound * mx * my * mz + overlap_underflow;
        int axes = 0, overlapping = 0;
        Answer answer = Answer::maybe;
        detail::any_axis(pair, [&](const Vec3<double>& n) {
            const double a1 = dot(n, pair.a[1]), a2 = dot(n, pair.a[2]);
            const double b0 = dot(n, pair.b[0]), b1 = dot(n, pair.b[1]), b2 = dot(n, pair.b[2]);
            const double low_a = std::min({0.0, a1, a2}), high_a = std::max({0.0, a1, a2});
            const double low_b = std::min({b0, b1, b2}), high_b = std::max({b0, b1, b2});
            const double margin =
                gap_bound * (std::abs(n.x) * mx + std::abs(n.y) * my + std::abs(n.z) * mz) +
                gap_underflow;
            ++axes;
            overlapping += high_a - low_b > clear && high_b - low_a > clear;
            if (low_b - high_a > margin || low_a - high_b > margin)
                answer = Answer::no;
            else if (axes == 11 && overlapping == 11)
                answer = Answer::yes;
            return answer != Answer::maybe;
        });
        return answer;
    }
};

} // namespace boxwood
