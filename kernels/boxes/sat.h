#pragma once

#include "kernels/arithmetic/float_mode.h"
#include "kernels/boxes/obb_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace boxwood {

/// Box b as seen from box a, and the gaps between the two along the 15 directions that can part
/// them if the axes are orthonormal: distance of the centres less the reach of both, times the
/// length of the direction (1, but shorter for edge x edge). Source: Gottschalk, Lin, Manocha 1996.
template <class Real> struct ObbPair {
    Vec3<Real> half_a, half_b;
    Vec3<Real> t;                               ///< from centre to centre
    std::array<std::array<Real, 3>, 3> r, size; ///< axis of a . axis of b; its magnitude

    ObbPair(const Obb<Real>& a, const Obb<Real>& b) : half_a(a.half), half_b(b.half) {
        const Vec3<Real> between = b.centre - a.centre;
        for (std::size_t i = 0; i < 3; ++i) {
            t[static_cast<int>(i)] = dot(a.axis[i], between);
            for (std::size_t j = 0; j < 3; ++j) {
                r[i][j] = dot(a.axis[i], b.axis[j]);
                size[i][j] = std::abs(r[i][j]);
            }
        }
    }

    Real face_of_a(int i) const {
        const auto& row = size[static_cast<std::size_t>(i)];
        return std::abs(t[i]) -
               (half_b.x * row[0] + half_b.y * row[1] + half_b.z * row[2] + half_a[i]);
    }
    Real face_of_b(int axis) const {
        const auto j = static_cast<std::size_t>(axis);
        return std::abs(t.x * r[0][j] + t.y * r[1][j] + t.z * r[2][j]) -
               (half_a.x * size[0][j] + half_a.y * size[1][j] + half_a.z * size[2][j] +
                half_b[axis]);
    }
    Real edges(int axis_a, int axis_b) const {
        const int p = next(axis_a), q = next(p), m = next(axis_b), n = next(m);
        const auto i = static_cast<std::size_t>(axis_a), j = static_cast<std::size_t>(axis_b);
        const auto ip = static_cast<std::size_t>(p), iq = static_cast<std::size_t>(q);
        const auto jm = static_cast<std::size_t>(m), jn = static_cast<std::size_t>(n);
        return std::abs(t[q] * r[ip][j] - t[p] * r[iq][j]) -
               (half_a[p] * size[iq][j] + half_a[q] * size[ip][j] + half_b[m] * size[i][jn] +
                half_b[n] * size[i][jm]);
    }
    /// At least the sine of the angle between two axes, at most sqrt(2) times it.
    Real sine(int axis_a, int axis_b) const {
        const auto& row = size[static_cast<std::size_t>(axis_a)];
        const int m = next(axis_b);
        return row[static_cast<std::size_t>(m)] + row[static_cast<std::size_t>(next(m))];
    }

  private:
    static constexpr int next(int axis) { return axis == 2 ? 0 : axis + 1; }
};

/// The 15 gaps as they round: wrong either way when they are small.
template <class Number> struct PlainSat {
    using Real = Number;
    static constexpr KernelInfo info{
        "obb_obb",
        std::is_same_v<Real, float> ? "sat_f32" : "sat_f64",
        "15 separating directions, as they round (Gottschalk, Lin, Manocha 1996)",
        Promise::none,
        "none: gaps are off by rounding and by what the axes lack of being orthonormal",
        "about 250 flops, fewer if apart"};
    static constexpr std::string_view name = info.name;

    static Decision overlap(const Obb<Real>& a, const Obb<Real>& b) {
        const ObbPair<Real> pair(a, b);
        Real sum = 0; // NaN or infinite if the input is
        for (int i = 0; i < 3; ++i)
            sum += std::abs(pair.t[i]) + pair.half_a[i] + pair.half_b[i] + pair.sine(0, i) +
                   pair.sine(1, i) + pair.sine(2, i);
        if (!(sum <= std::numeric_limits<Real>::max()))
            return {Answer::maybe};
        for (int i = 0; i < 3; ++i)
            if (pair.face_of_a(i) > 0 || pair.face_of_b(i) > 0)
                return {Answer::no};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (pair.edges(i, j) > 0)
                    return {Answer::no};
        return {Answer::yes};
    }
};

/// The 15 gaps against their error: no if one is surely above 0, yes if all are surely below it,
/// maybe between, for axes too far from orthonormal (by 1 %), and for sizes that overflow.
/// Denormals are kept where the caller flushes them.
///
/// Bound. u is the unit roundoff, T the vector between the centres, H the sum of all six half
/// sizes. Let M be the axes of a box, d >= |M'M - 1| (the norm that d = the largest row sum
/// bounds). The nearest orthonormal axes are within w = 0.51 d of M, so the box is within w H of an
/// ideal one. With w = w_a + w_b: |error of r| <= 1.01 w + 3.1u, |error of t| <= |T| (w_a + 4.1u);
/// a gap sums at most three of their products, its reach passes 4 roundings: off from the ideal gap
/// by at most |T| (3.5 w + 16.7u) + H (1.01 w + 8.3u). The ideal boxes are off by w H more:
///   E = (2 d + 20u) |T| + (1.1 d + 10u) H, d = d_a + d_b, 20u added for its own rounding.
/// no: the ideal boxes are farther apart than the true ones are from them.
/// yes: gaps below -E put T deep inside the sum of both ideal boxes, by its faces. Two axes nearly
/// parallel (sine s <= sqrt(u)) give no gap to rely on. There b's axis is replaced by a's, s away,
/// and their edges bound nothing any more; T, H and the other gaps move by less than
/// 5 (s + error of r) (|T| + H) together, by which those must be deeper.
/// Underflow: fewer than 32 operations lose half a denormal_min each.
template <class Number> struct CertifiedSat {
    using Real = Number;
    static constexpr KernelInfo info{
        "obb_obb",
        std::is_same_v<Real, float> ? "sat_certified_f32" : "sat_certified",
        "15 separating directions, decided where their error bound allows",
        Promise::certified,
        "gap off by (20u + 2d) |T| + (10u + 1.1d) H, d what the axes lack of being orthonormal; "
        "derived in boxes/sat.h",
        "about 350 flops"};
    static constexpr std::string_view name = info.name;

    static Decision overlap(const Obb<Real>& a, const Obb<Real>& b) {
        return without_flushing([&] { return decided(a, b); });
    }

  private:
    using Limits = std::numeric_limits<Real>;
    static constexpr Real u = Limits::epsilon() / 2;
    /// About sqrt(u): below it the edges of two axes say too little, above it enough.
    static constexpr Real parallel = std::is_same_v<Real, float> ? Real(0x1p-12) : Real(0x1p-26);

    /// What the axes lack of being orthonormal: a bound on the norm of M'M - 1.
    static Real defect(const Obb<Real>& box) {
        const auto& [x, y, z] = box.axis;
        const Real xy = std::abs(dot(x, y)), yz = std::abs(dot(y, z)), zx = std::abs(dot(z, x));
        return std::max({std::abs(dot(x, x) - 1) + xy + zx, std::abs(dot(y, y) - 1) + xy + yz,
                         std::abs(dot(z, z) - 1) + yz + zx}) +
               10 * u;
    }

    static Decision decided(const Obb<Real>& a, const Obb<Real>& b) {
        const ObbPair<Real> pair(a, b);
        const Vec3<Real> between = b.centre - a.centre;
        const Real distance = std::abs(between.x) + std::abs(between.y) + std::abs(between.z);
        const Real halves = pair.half_a.x + pair.half_a.y + pair.half_a.z + pair.half_b.x +
                            pair.half_b.y + pair.half_b.z;
        const Real lack = defect(a) + defect(b);
        const Real error = (2 * lack + 20 * u) * distance + (Real(1.1) * lack + 10 * u) * halves +
                           32 * Limits::denorm_min();
        if (!(lack < Real(0.01) && distance + halves <= Limits::max() / 8))
            return {Answer::maybe};

        Real deepest = -Limits::infinity(); // the greatest gap that is relied on
        for (int i = 0; i < 3; ++i) {
            const Real gap = std::max(pair.face_of_a(i), pair.face_of_b(i));
            if (gap > error)
                return {Answer::no};
            deepest = std::max(deepest, gap);
        }
        Real leaning = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const Real gap = pair.edges(i, j), sine = pair.sine(i, j);
                if (gap > error)
                    return {Answer::no};
                if (sine <= parallel)
                    leaning = std::max(leaning, sine + 2 * lack + 10 * u);
                else
                    deepest = std::max(deepest, gap);
            }
        const Real margin = error + 5 * leaning * (distance + halves);
        return {deepest < -margin ? Answer::yes : Answer::maybe};
    }
};

} // namespace boxwood
