#pragma once

#include "kernels/continuous/continuous_kernel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

/// The function whose zeros are the touches of two moving features, and a bound on the rounding of
/// its values, as in Wang et al. 2021, "A Large Scale Benchmark and an Inclusion-Based Algorithm
/// for Continuous Collision Detection".
namespace boxwood::detail::inclusion {

/// Parameters (u, v) of a part of the features: the corners of a triangle or of a rectangle, in
/// order around it. Its halves cover it exactly: midpoints are exact to a depth of 50.
template <int n> struct Patch {
    std::array<double, n> u, v;

    static constexpr Patch whole() {
        if constexpr (n == 3)
            return {{0, 1, 0}, {0, 0, 1}};
        else
            return {{0, 1, 1, 0}, {0, 0, 1, 1}};
    }
    /// Becomes one half and returns the other; the edge from corner i to the next is cut in the
    /// middle, in a rectangle also the one across from it.
    Patch halve(int edge) {
        const auto i = static_cast<std::size_t>(edge), j = (i + 1) % n;
        Patch other = *this;
        const double mid_u = (u[i] + u[j]) / 2, mid_v = (v[i] + v[j]) / 2;
        if constexpr (n == 3) {
            u[j] = other.u[i] = mid_u;
            v[j] = other.v[i] = mid_v;
        } else {
            const std::size_t k = (i + 2) % n, l = (i + 3) % n;
            auto &moved = i % 2 == 0 ? u : v, &others = i % 2 == 0 ? other.u : other.v;
            moved[j] = moved[k] = others[i] = others[l] = i % 2 == 0 ? mid_u : mid_v;
        }
        return other;
    }
};

/// The bits of the largest of |coordinates|, at least infinity's if one is not finite.
inline std::uint64_t largest_bits(const LinearMotion& motion) {
    std::uint64_t max_bits = 0;
    for (const auto* points : {&motion.start, &motion.end})
        for (const Vec3<double>& p : *points)
            for (const double x : {p.x, p.y, p.z})
                max_bits = std::max(max_bits, std::bit_cast<std::uint64_t>(x) << 1);
    return max_bits >> 1;
}

/// F(t, u, v) = (1 - t) (a0 + u b0 + v c0) + t (a1 + u b1 + v c1), scaled by a power of two.
/// n = 3, vertex-face: the vertex minus the face's point (1 - u - v, u, v), on the triangle u, v,
/// 1 - u - v >= 0. n = 4, edge-edge: a point of the first edge minus one of the second, on the
/// unit square. For a fixed t it is affine in (u, v), so its values on a patch are the hull of
/// those at the corners.
///
/// Rounding, with U = 2^-53: the coordinates are exact, a, b and c err by U each, relatively, so
/// (a + u b) + v c errs by U (3|a| + 4|b| + 3|c|) <= 4U w, w = |a| + |b| + |c|. For a direction d,
/// taken as exact, d.F adds 3U |d|.r in the scalar product and 3U |d|.r in the mean over t, where
/// r is the largest |F|, by axis. So |error| <= |d| . (4U w + 6U r) and terms in U^2, which the
/// last digits in `bound` cover.
/// F and this bound are homogeneous of degree 1 in the coordinates: it fits every scale without a
/// clamp. With |x| <= m it is at most 36U m per axis; the published one is 60U m or more for
/// vertex-face, 56U m for edge-edge (6.661e-15, 6.217e-15), for another order of operations.
/// Underflow: scaling puts the largest |x| into [1/2, 1); each of the fewer than 64 operations may
/// lose 2^-1074 (`min_error`).
template <int n> struct Inclusion {
    struct Ends {
        Vec3<double> a, b, c;
        Vec3<double> at(double u, double v) const { return (a + b * u) + c * v; }
    };
    Ends start, end;
    Vec3<double> bound;
    double size = 0;   ///< the largest |F| on any axis, not below by more than rounding
    double half, rest; ///< their product is the scale

    static constexpr double min_error = 0x1p-1060;

    /// `bits` = largest_bits(motion), finite.
    Inclusion(const LinearMotion& motion, std::uint64_t bits) {
        // 2^-exponent in two factors, as it may be beyond the doubles.
        const int exponent =
            bits == 0 ? 0 : std::ilogb(std::bit_cast<double>(bits)) + 1; // |x| < 2^exponent
        half = std::ldexp(1.0, -exponent / 2);
        rest = std::ldexp(1.0, -exponent - -exponent / 2);
        start = ends(motion.start, half, rest);
        end = ends(motion.end, half, rest);
        Vec3<double> w{}, r{};
        constexpr Patch<n> all = Patch<n>::whole();
        for (const Ends* side : {&start, &end}) {
            const Vec3<double> sum = absolute(side->a) + absolute(side->b) + absolute(side->c);
            w = max(w, sum);
            for (std::size_t i = 0; i < n; ++i)
                r = max(r, absolute(side->at(all.u[i], all.v[i])));
        }
        size = std::max({r.x, r.y, r.z});
        bound = w * (4.01 * 0x1p-53) + r * (6.01 * 0x1p-53);
    }

    /// |error| of a computed d.F(t, u, v), the mean over t included, for |d| <= 1 on each axis.
    double margin(Vec3<double> d) const {
        return dot(absolute(d), bound) * (1 + 0x1p-50) + min_error;
    }

    /// A length at that scale, rounded up.
    double scaled(double length) const {
        return length <= 0 ? 0 : (length * half) * rest * (1 + 0x1p-50) + min_error;
    }

    static Vec3<double> absolute(Vec3<double> a) {
        return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
    }

  private:
    static Ends ends(const std::array<Vec3<double>, 4>& given, double half, double rest) {
        std::array<Vec3<double>, 4> p;
        for (std::size_t i = 0; i < 4; ++i)
            p[i] = (given[i] * half) * rest;
        if constexpr (n == 3)
            return {p[0] - p[1], p[1] - p[2], p[1] - p[3]};
        else
            return {p[0] - p[2], p[1] - p[0], p[2] - p[3]};
    }
};

/// The mean of the values at the start and at the end.
inline double mean(double start, double end, double t) { return (1 - t) * start + t * end; }
inline Vec3<double> mean(Vec3<double> start, Vec3<double> end, double t) {
    return start * (1 - t) + end * t;
}

} // namespace boxwood::detail::inclusion
