#pragma once

#include "kernels/joined.h"
#include "kernels/predicates/orientation.h"
#include "kernels/triangle_triangle/flat.h"
#include "kernels/triangle_triangle/triangle_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace boxwood {

/// Whether two closed triangles share a point, from nothing but signs of orientation determinants:
/// 6 that place each triangle's corners against the other's plane, then 2 that compare the
/// intervals which the triangles cut out of the planes' common line. Coplanar and degenerate pairs
/// go to FlatPair. As right as its Predicates; `maybe` if a sign it needed was undecided. Source:
/// Guigue, Devillers 2003, "Fast and Robust Triangle-Triangle Overlap Test Using Orientation
/// Predicates".
template <OrientationPredicates P> struct GuigueDevillers {
  private:
    static constexpr std::string_view name_prefix = "guigue_devillers_";
    static constexpr std::string_view summary_prefix =
        "interval overlap on the common line by orientation signs (2003), degenerate pairs by "
        "rank: ";

  public:
    using Real = double;
    static constexpr std::string_view name = Joined<name_prefix, P::name>::value;
    static constexpr KernelInfo info{
        "triangle_triangle", name,     Joined<summary_prefix, P::summary>::value,
        P::promise,          P::bound, P::cost};

    static Verdict intersect(const Triangle<double>& a, const Triangle<double>& b) {
        Signs<P> signs;
        const bool yes = meet(signs, a, b);
        const Answer answer = signs.unsure() ? Answer::maybe : yes ? Answer::yes : Answer::no;
        return {answer, P::tier};
    }

  private:
    using Corners = std::array<Vec3<double>, 3>;
    using Sides = std::array<int, 3>;

    /// On which side of the plane of `t` each of the points lies.
    static Sides sides(Signs<P>& signs, const Corners& t, const Corners& points) {
        return {signs.orient3d(t[0], t[1], t[2], points[0]),
                signs.orient3d(t[0], t[1], t[2], points[1]),
                signs.orient3d(t[0], t[1], t[2], points[2])};
    }

    /// The corner that a plane parts from the other two: it lies on side `sign` (or on the plane,
    /// and the others strictly on the other side); the others on side -sign or on the plane.
    struct Lone {
        std::size_t corner;
        int sign;
    };

    /// Of the sides that are neither all equal and strict nor all zero:
    /// one corner above -> it; else one below -> it; else (0, +, +) or (0, -, -) -> the zero.
    static Lone lone(const Sides& s) {
        const auto find = [&](int side) {
            return static_cast<std::size_t>(std::find(s.begin(), s.end(), side) - s.begin());
        };
        const auto above = std::count(s.begin(), s.end(), 1);
        const auto below = std::count(s.begin(), s.end(), -1);
        if (above == 1)
            return {find(1), 1};
        if (below == 1)
            return {find(-1), -1};
        return {find(0), above == 2 ? -1 : 1};
    }

    /// The corners from the lone one on; the last two swapped if `sign` is -1, which turns the
    /// triangle's plane over.
    static Corners from(const Corners& t, std::size_t corner, int sign) {
        const Vec3<double> next = t[(corner + 1) % 3], last = t[(corner + 2) % 3];
        return sign > 0 ? Corners{t[corner], next, last} : Corners{t[corner], last, next};
    }

    static bool meet(Signs<P>& signs, const Triangle<double>& first,
                     const Triangle<double>& second) {
        const Corners a{first.a, first.b, first.c}, b{second.a, second.b, second.c};
        const auto strictly_one_side = [](const Sides& s) {
            return s[0] != 0 && s[0] == s[1] && s[0] == s[2];
        };
        const Sides of_b = sides(signs, a, b);
        if (strictly_one_side(of_b))
            return false;
        const Sides of_a = sides(signs, b, a);
        if (strictly_one_side(of_a))
            return false;
        // Coplanar, or one of them has no plane.
        if (of_a == Sides{} || of_b == Sides{})
            return FlatPair<P>::meet(signs, a, b);

        // Turned so that each lone corner lies on the positive side of the other's plane, the
        // common line leaves a between q1 and r1, and b between q2 and r2.
        const Lone la = lone(of_a), lb = lone(of_b);
        const auto [p1, q1, r1] = from(a, la.corner, lb.sign);
        const auto [p2, q2, r2] = from(b, lb.corner, la.sign);
        return signs.orient3d(q1, p2, p1, q2) <= 0 && signs.orient3d(p1, p2, r1, r2) <= 0;
    }
};

} // namespace boxwood
