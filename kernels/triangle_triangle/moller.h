#pragma once

#include "kernels/predicates/rounded.h"
#include "kernels/triangle_triangle/detail/flat.h"
#include "kernels/triangle_triangle/triangle_kernel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace boxwood {

/// Whether two closed triangles share a point: each one's corners against the other's plane, then
/// the intervals that the two cut out of the planes' common line; coplanar and degenerate pairs by
/// FlatPair. Exact while the products fit the significand (integers up to 2^6 in double, 4 in
/// float), else wrong where the two nearly touch. `maybe` for NaN, infinity and overflow.
/// Source: Moeller 1997, "A Fast Triangle-Triangle Intersection Test", without divisions.
template <class RealT> struct Moller {
    using Real = RealT;
    static constexpr bool single = std::is_same_v<Real, float>;
    static constexpr std::string_view name = single ? "moller_f32" : "moller_f64";
    static constexpr KernelInfo info{
        "triangle_triangle",
        name,
        single ? "plane tests and interval overlap on the common line (1997) in float"
               : "plane tests and interval overlap on the common line (1997) in double",
        Promise::none,
        "none: the interval ends cancel without limit as the planes become parallel",
        "about 150 flops"};

    static Decision intersect(const Triangle<Real>& a, const Triangle<Real>& b) {
        return {answer(a, b), 0};
    }

  private:
    using Vector = Vec3<Real>;
    using Heights = std::array<Real, 3>;
    using Corners = std::array<Vector, 3>;

    static Answer answer(const Triangle<Real>& a, const Triangle<Real>& b) {
        // All corners from a's first one, so that far from the origin nothing more is lost.
        const Corners p{Vector{}, a.b - a.a, a.c - a.a}, q{b.a - a.a, b.b - a.a, b.c - a.a};
        const Vector n2 = cross(b.b - b.a, b.c - b.a);
        const Heights of_a = {dot(n2, a.a - b.a), dot(n2, a.b - b.a), dot(n2, a.c - b.a)};
        if (strictly_one_side(of_a))
            return no_if_finite(of_a[0] + of_a[1] + of_a[2]);
        const Vector n1 = cross(p[1], p[2]);
        const Heights of_b = {dot(n1, q[0]), dot(n1, q[1]), dot(n1, q[2])};
        if (strictly_one_side(of_b))
            return no_if_finite(of_b[0] + of_b[1] + of_b[2]);
        // Coplanar, or one of them has no plane.
        if (of_a == Heights{} || of_b == Heights{}) {
            detail::Signs<Rounded<Real>> signs(a, b);
            return detail::FlatPair<detail::Signs<Rounded<Real>>>::meet(signs);
        }

        const Vector line = cross(n1, n2);
        const Real x = std::abs(line.x), y = std::abs(line.y), z = std::abs(line.z);
        const std::size_t axis = z > std::max(x, y) ? 2 : y > x;
        const std::array<Heights, 3> by_axis_p{
            Heights{0, p[1].x, p[2].x}, {0, p[1].y, p[2].y}, {0, p[1].z, p[2].z}};
        const std::array<Heights, 3> by_axis_q{
            Heights{q[0].x, q[1].x, q[2].x}, {q[0].y, q[1].y, q[2].y}, {q[0].z, q[1].z, q[2].z}};
        // Two interval ends each, as fractions; the intervals are disjoint iff all differences of
        // an end of a and one of b have the same sign.
        const Ends ends_a = ends(by_axis_p[axis], of_a), ends_b = ends(by_axis_q[axis], of_b);
        const Real d00 = difference(ends_a[0], ends_b[0]), d01 = difference(ends_a[0], ends_b[1]),
                   d10 = difference(ends_a[1], ends_b[0]), d11 = difference(ends_a[1], ends_b[1]);
        if (!(x + y + z > 0) || !std::isfinite(d00 + d01 + d10 + d11))
            return Answer::maybe; // overflow, NaN, or a line lost to underflow
        const bool apart = (d00 > 0 && d01 > 0 && d10 > 0 && d11 > 0) ||
                           (d00 < 0 && d01 < 0 && d10 < 0 && d11 < 0);
        return apart ? Answer::no : Answer::yes;
    }

    static bool strictly_one_side(const Heights& h) {
        return std::min({h[0], h[1], h[2]}) > 0 || std::max({h[0], h[1], h[2]}) < 0;
    }

    /// Every coordinate of both triangles is in the sum.
    static Answer no_if_finite(Real sum) { return std::isfinite(sum) ? Answer::no : Answer::maybe; }

    /// A position along the common line; weight >= 0, and 0 only where a height is NaN or lost.
    struct End {
        Real moment, weight;
    };
    using Ends = std::array<End, 2>;

    /// Where the two edges from the lone corner (guigue_devillers.h has the cases) cross the other
    /// triangle's plane.
    static Ends ends(const Heights& t, const Heights& h) {
        unsigned above = 0, below = 0;
        for (unsigned k = 0; k < 3; ++k) {
            above |= unsigned{h[k] > 0} << k;
            below |= unsigned{h[k] < 0} << k;
        }
        const unsigned alone = std::has_single_bit(above)   ? above
                               : std::has_single_bit(below) ? below
                                                            : 7 & ~(above | below);
        const auto lone = static_cast<std::size_t>(std::countr_zero(alone | 4));
        const std::size_t next = (lone + 1) % 3, last = (lone + 2) % 3;
        const auto end = [&](std::size_t other) {
            const Real moment = t[other] * h[lone] - t[lone] * h[other];
            const Real weight = h[lone] - h[other];
            return weight < 0 ? End{-moment, -weight} : End{moment, weight};
        };
        return {end(next), end(last)};
    }

    static Real difference(const End& a, const End& b) {
        return a.moment * b.weight - b.moment * a.weight;
    }
};

using MollerF32 = Moller<float>;
using MollerF64 = Moller<double>;

} // namespace boxwood
