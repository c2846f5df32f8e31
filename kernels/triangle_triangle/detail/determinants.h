#pragma once

#include "kernels/predicates/detail/binary64.h"
#include "kernels/predicates/detail/two.h"
#include "kernels/predicates/filtered.h"
#include "kernels/triangle_triangle/detail/flat.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace boxwood::detail {

/// The signs of a pair by determinants in plain Real arithmetic, normals shared, two at a time, no
/// branch on a sign. With `filtered` (double only), just those that the error bound of
/// predicates/filtered.h lets stand, S taken from the triangles' extents: a triple product has a
/// factor of each axis, and rounding is monotone, so that no computed difference exceeds its
/// computed extent.
template <class R, bool filtered = false> class Determinants {
    static_assert(!filtered || std::is_same_v<R, double>);
    friend class Determinants<R, false>;
    using Two = typename TwoOf<R>::Values;
    using Bits = typename TwoOf<R>::Bits;
    using Bit = typename TwoOf<R>::Bit;

  public:
    using Real = R;

    Determinants(const Triangle<Real>& a, const Triangle<Real>& b)
        : p_{&a.a, &a.b, &a.c, &b.a, &b.b, &b.c} {
        const Points p = points(0, 3), q = points(1, 4), r = points(2, 5);
        // First a's corners to b's plane, second b's to a's.
        const Points base = swapped(p), edge = q - p, other_edge = r - p, first = p - base;
        const Points n = swapped(cross(edge, other_edge));
        normal_ = {n.x, n.y, n.z};
        heights_ = {dot(first, n), dot(q - base, n), dot(r - base, n)};
        Two error{};
        if constexpr (filtered) {
            error = set_reach(largest(edge), largest(other_edge), largest(first)[0]);
            const auto& [hp, hq, hr] = heights_;
            const Two lowest = min_of(min_of(hp, hq), hr), highest = max_of(max_of(hp, hq), hr);
            const Two sum = hp + hq + hr;
            const Bits parted = ((lowest > error) | (highest < -error)) & (sum == sum);
            parted_ = (parted[0] | parted[1]) != 0;
            if (parted_)
                return;
        }
        judge(error);
    }

    /// The same determinants, taken at their word.
    template <bool other>
    requires(other && !filtered) explicit Determinants(const Determinants<Real, other>& pair)
        : p_(pair.p_), normal_(pair.normal_), heights_(pair.heights_) {
        judge(Two{});
    }

    /// Of a filtered pair: takes the triangles' extents for the bounds, axis by axis, which else
    /// come from the edges' largest components. Needed before all but sides() and
    /// overlap_along_line().
    void narrow() requires(filtered) {
        if (narrow_)
            return;
        narrow_ = true;
        const Points p = points(0, 3), q = points(1, 4), r = points(2, 5);
        const Points low = min(min(p, q), r), high = max(max(p, q), r);
        const Points gap = low - swapped(high);
        const Two widest = max_of(max_of(gap.x, gap.y), gap.z);
        apart_ = std::max(widest[0], widest[1]) > 0;
        judge(set_extents(low, high));
    }

    /// Of a filtered pair: whether a triangle's plane parts it from the other. If so, nothing else
    /// here has a value.
    bool parted() const { return parted_; }
    /// Whether an axis parts the triangles' boxes; for a narrowed pair only.
    bool boxes_apart() const { return apart_; }

    Sides sides(int of) const {
        const auto bits = [of](const Bits& b) { return static_cast<unsigned>(b[of == 0 ? 1 : 0]); };
        const unsigned above = bits(above_), below = bits(below_);
        return {above, below, 7 & ~(filtered ? above | below : bits(known_))};
    }

    Sides decided_sides(int of) const { return sides(of); }

    /// The normals here are those of an edge of each triangle.
    Answer overlap_along_line(const Turned& a, const Turned& b) const {
        const Points a0 = points(a.q, a.p), a1 = points(a.p, a.r);
        const Points b0 = points(b.p, b.p), b1 = points(b.q, b.r);
        const Two det = dot(b0 - a0, cross(a1 - a0, b1 - b0));
        const Real error = filtered && !narrow_ ? error_along_line_ : error3d();
        const Bits apart = det > error, meet = filtered ? det < -error : det <= error;
        return (apart[0] | apart[1]) != 0 ? Answer::no
               : (meet[0] & meet[1]) != 0 ? Answer::yes
                                          : Answer::maybe;
    }

    int orient3d(Corner a, Corner b, Corner c, Corner d) const {
        const Vec3<Real> pa = *p_[a];
        return sign(dot(*p_[d] - pa, cross(*p_[b] - pa, *p_[c] - pa)), error3d());
    }

    int orient2d(int dropped, Corner a, Corner b, Corner c) const {
        const auto [u, v] = plane_axes[dropped];
        const Real pu = at(a, u), pv = at(a, v);
        return sign((at(b, u) - pu) * (at(c, v) - pv) - (at(b, v) - pv) * (at(c, u) - pu),
                    error2d(u, v));
    }

    /// The edges of both triangles at a time, the other's corners against each: by edge the corner
    /// farthest inside, of these the one least so. Is it outside, or inside?
    Answer overlap_in_plane(int dropped, int turn_a, int turn_b) const {
        const auto [u, v] = plane_axes[dropped];
        const Two u0{at(0, u), at(3, u)}, u1{at(1, u), at(4, u)}, u2{at(2, u), at(5, u)};
        const Two v0{at(0, v), at(3, v)}, v1{at(1, v), at(4, v)}, v2{at(2, v), at(5, v)};
        const Two ou0 = swapped(u0), ou1 = swapped(u1), ou2 = swapped(u2);
        const Two ov0 = swapped(v0), ov1 = swapped(v1), ov2 = swapped(v2);
        const Two turn{static_cast<Real>(turn_a), static_cast<Real>(turn_b)};
        const auto farthest = [&](const Two& pu, const Two& pv, const Two& qu, const Two& qv) {
            const Two du = turn * (qu - pu), dv = turn * (qv - pv);
            const auto inside = [&](const Two& ou, const Two& ov) -> Two {
                return du * (ov - pv) - dv * (ou - pu);
            };
            return max_of(max_of(inside(ou0, ov0), inside(ou1, ov1)), inside(ou2, ov2));
        };
        const Two min_height = min_of(min_of(farthest(u0, v0, u1, v1), farthest(u1, v1, u2, v2)),
                                      farthest(u2, v2, u0, v0));
        const Real worst = std::min(min_height[0], min_height[1]), error = error2d(u, v);
        return worst < -error ? Answer::no
               : filtered     ? (worst > error ? Answer::yes : Answer::maybe)
                              : (worst >= error ? Answer::yes : Answer::maybe);
    }

    /// The largest component of the normal is the surest.
    Projection project(int of, Projection like) const {
        const int lane = of == 0 ? 1 : 0;
        const auto turn = [&](int axis) {
            const auto [u, v] = plane_axes[axis];
            return sign(normal_[static_cast<std::size_t>(axis)][lane], error2d(u, v));
        };
        if (like)
            if (const int t = turn(like.axis()); t == 1 || t == -1)
                return {like.axis(), t};
        const int axis =
            largest_axis(Vec3<Real>{normal_[0][lane], normal_[1][lane], normal_[2][lane]});
        const int t = turn(axis);
        return t == undecided ? Projection::undecided() : Projection(axis, t);
    }

    Vec3<Real> point(Corner k) const { return *p_[k]; }
    const std::array<const Vec3<Real>*, 6>& points() const { return p_; }

    /// By corner of a and b: the sum of its coordinates, rounded, never -0.
    struct Sums {
        Two of[3];
    };
    Sums sums() const {
        const auto sum = [](const Points& p) -> Two { return p.x + p.y + p.z + Real{0}; };
        return {{sum(points(0, 3)), sum(points(1, 4)), sum(points(2, 5))}};
    }
    /// Whether no coordinate is an infinity or NaN; if so, perhaps false for huge ones.
    static bool surely_finite(const Sums& sums) {
        const Two all = sums.of[0] + sums.of[1] + sums.of[2];
        return all[0] + all[1] - (all[0] + all[1]) == 0;
    }
    /// Whether a corner of one is a corner of the other, in any floating-point mode: then their
    /// sums are the same bits.
    bool share_a_vertex(const Sums& sums) const {
        const Bits p = std::bit_cast<Bits>(sums.of[0]), q = std::bit_cast<Bits>(sums.of[1]),
                   r = std::bit_cast<Bits>(sums.of[2]);
        const auto is_of_b = [&](Bit a) { return a == p[1] || a == q[1] || a == r[1]; };
        if (!is_of_b(p[0]) && !is_of_b(q[0]) && !is_of_b(r[0])) [[likely]]
            return false;
        for (Corner i = 0; i < 3; ++i)
            for (Corner j = 3; j < 6; ++j)
                if (is_same_number_bits(p_[i]->x, p_[j]->x) &&
                    is_same_number_bits(p_[i]->y, p_[j]->y) &&
                    is_same_number_bits(p_[i]->z, p_[j]->z))
                    return true;
        return false;
    }
    /// Of a filtered pair: whether all corners have a coordinate in common.
    bool in_coordinate_plane() const {
        return extent_[0] == 0 || extent_[1] == 0 || extent_[2] == 0;
    }
    /// Of a filtered pair: whether no determinant of it is rounded. On each axis, with the extent
    /// J, 2^e <= J < 2^(e+1), all coordinates must be multiples of g = 2^(e-15): then differences,
    /// below 2^16 g, are exact, and so are minors below 2^33 and determinants below 6 * 2^48 of
    /// their units. x + 1.5 * 2^52 g rounds to a multiple of g if |x| < 2^51 g.
    bool rounds_nothing() const {
        const Points a = points(0, 3), b = points(1, 4), c = points(2, 5);
        const auto on_grid = [](Real extent, const Two& p, const Two& q, const Two& r) {
            constexpr Bit exponent_bits = Bit{0x7ff} << 52;
            const Real power = std::bit_cast<Real>(std::bit_cast<Bit>(extent) & exponent_bits);
            const Real round = power * 0x1.8p37;
            const auto off = [round](const Two& x) -> Bits {
                return std::bit_cast<Bits>((x + round) - round - x);
            };
            const Bits lost = off(p) | off(q) | off(r);
            return (lost[0] | lost[1]) == 0 &&
                   (extent == 0 || (extent > 0x1p-300 && extent < filter_bound::largest &&
                                    std::abs(p[0]) < power * 0x1p35));
        };
        return on_grid(extent_[0], a.x, b.x, c.x) && on_grid(extent_[1], a.y, b.y, c.y) &&
               on_grid(extent_[2], a.z, b.z, c.z);
    }

  private:
    using Points = Vec3<Two>;

    static constexpr Real Vec3<Real>::*axes[3] = {&Vec3<Real>::x, &Vec3<Real>::y, &Vec3<Real>::z};
    Real at(Corner k, int axis) const { return p_[k]->*axes[axis]; }
    Points points(Corner a, Corner b) const {
        return {Two{p_[a]->x, p_[b]->x}, Two{p_[a]->y, p_[b]->y}, Two{p_[a]->z, p_[b]->z}};
    }
    static Two swapped(const Two& v) { return __builtin_shufflevector(v, v, 1, 0); }
    static Two min_of(const Two& a, const Two& b) { return b < a ? b : a; }
    static Two max_of(const Two& a, const Two& b) { return a < b ? b : a; }
    static Points swapped(const Points& p) { return {swapped(p.x), swapped(p.y), swapped(p.z)}; }

    /// The signs of the heights, with the errors of sides(1) and sides(0).
    void judge(const Two& error) {
        const auto& [p, q, r] = heights_;
        const Bits bit_p = Bits{} + 1, bit_q = Bits{} + 2, bit_r = Bits{} + 4;
        above_ = ((p > error) & bit_p) | ((q > error) & bit_q) | ((r > error) & bit_r);
        below_ = ((p < -error) & bit_p) | ((q < -error) & bit_q) | ((r < -error) & bit_r);
        if constexpr (!filtered)
            known_ = ((p == p) & bit_p) | ((q == q) & bit_q) | ((r == r) & bit_r);
    }

    static Two largest(const Points& v) {
        const auto abs = [](const Two& x) -> Two {
            return std::bit_cast<Two>(std::bit_cast<Bits>(x) & std::numeric_limits<Bit>::max());
        };
        return max_of(max_of(abs(v.x), abs(v.y)), abs(v.z));
    }
    /// Those errors, from the largest components of a's and b's edges at their first corners, and
    /// of the step between these. No edge is longer than twice the `longer` one, no corner farther
    /// from another than `reach`. NaN makes the determinants that it is in NaN.
    Two set_reach(const Two& edge, const Two& other_edge, Real first) {
        const Two longer = max_of(edge, other_edge);
        const Real reach = first + (longer[0] + longer[1]);
        scale_ = reach < filter_bound::largest ? 2 : std::numeric_limits<Real>::infinity();
        const Real bound = 3 * scale_ * filter_bound::orient3d * reach;
        error_along_line_ = 4 * bound * (longer[0] * longer[1]) + filter_bound::flushing;
        return bound * swapped(edge * other_edge) + filter_bound::flushing;
    }
    /// The same from the extents.
    Two set_extents(const Points& low, const Points& high) {
        const Points t = swapped(high - low);
        const Points both = max(high, swapped(high)) - min(low, swapped(low));
        extent_ = {both.x[0], both.y[0], both.z[0]};
        const Real max_extent = std::max(std::max(extent_[0], extent_[1]), extent_[2]);
        // Beyond `largest`, and with an infinity among the extents, no error stands (it is infinite
        // or NaN); NaN makes its determinants NaN.
        scale_ = max_extent < filter_bound::largest ? 2 : std::numeric_limits<Real>::infinity();
        const Two half = t.x * t.y * both.z + t.y * t.z * both.x + t.z * t.x * both.y;
        return scale_ * filter_bound::orient3d * half + filter_bound::flushing;
    }
    Real error3d() const {
        if constexpr (filtered)
            return 3 * scale_ * filter_bound::orient3d * (extent_[0] * extent_[1] * extent_[2]) +
                   filter_bound::flushing;
        return 0;
    }
    Real error2d(int u, int v) const {
        if constexpr (filtered)
            return scale_ * filter_bound::orient2d * extent_[static_cast<std::size_t>(u)] *
                       extent_[static_cast<std::size_t>(v)] +
                   filter_bound::flushing;
        return 0;
    }

    static int sign(Real det, Real error) {
        if (filtered)
            return det > error ? 1 : det < -error ? -1 : undecided;
        return det == det ? int{det > 0} - int{det < 0} : undecided;
    }
    std::array<const Vec3<Real>*, 6> p_;
    std::array<Two, 3> normal_;  ///< of b and a, by axis
    std::array<Two, 3> heights_; ///< determinants, by corner of a and b
    Bits above_, below_, known_;
    std::array<Real, 3> extent_;
    Real scale_ = 2;
    Real error_along_line_ = 0; ///< until it is narrowed
    bool parted_ = false, narrow_ = false, apart_ = false;
};

using FilteredPair = Determinants<double, true>;

} // namespace boxwood::detail
