#pragma once

#include "kernels/arithmetic/on_both.h"
#include "kernels/predicates/orientation.h"
#include "kernels/primitives/triangle.h"

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>

namespace boxwood::detail {

/// A corner of a pair of triangles: 0, 1, 2 of the first, 3, 4, 5 of the second.
using Corner = std::size_t;

/// On which side of a triangle's plane the other's corners lie: bit k for the other's corner k. On
/// the plane is neither above nor below; `unknown` was not decided. In one register.
class Sides {
  public:
    Sides() = default;
    BOXWOOD_BOTH Sides(unsigned above, unsigned below, unsigned unknown)
        : bits_(above | below << 3 | unknown << 6) {}

    BOXWOOD_BOTH unsigned above() const { return bits_ & 7; }
    BOXWOOD_BOTH unsigned below() const { return bits_ >> 3 & 7; }
    BOXWOOD_BOTH unsigned unknown() const { return bits_ >> 6; }
    BOXWOOD_BOTH unsigned above_and_below() const { return bits_ & 63; }
    BOXWOOD_BOTH bool strictly_one_side() const { return one_strictly_one_side(*this, *this); }
    /// Of either triangle; in one branch.
    BOXWOOD_BOTH static bool one_strictly_one_side(const Sides& a, const Sides& b) {
        constexpr std::uint64_t all_above_or_all_below = 1ull << 7 | 1ull << (7 << 3);
        return ((all_above_or_all_below >> a.above_and_below() |
                 all_above_or_all_below >> b.above_and_below()) &
                1) != 0;
    }
    BOXWOOD_BOTH bool all_on_plane() const { return bits_ == 0; }

    /// What was not known of corner k.
    BOXWOOD_BOTH void decide(Corner k, int sign) {
        bits_ &= ~(64u << k);
        bits_ |= sign > 0 ? 1u << k : sign < 0 ? 8u << k : 0;
    }

  private:
    unsigned bits_ = 0;
};

/// The coordinate plane (the axis to drop, 0 .. 2) that a triangle is projected on one to one, and
/// the sign of its turn there; or none, as it is degenerate or that is undecided. In one register.
class Projection {
  public:
    Projection() = default;
    BOXWOOD_BOTH Projection(int axis, int turn) : code_(turn * (axis + 1)) {}
    BOXWOOD_BOTH static Projection undecided() {
        Projection p;
        p.code_ = 4;
        return p;
    }

    BOXWOOD_BOTH bool is_undecided() const { return code_ == 4; }
    BOXWOOD_BOTH explicit operator bool() const { return code_ != 0 && code_ != 4; }
    BOXWOOD_BOTH int axis() const { return (code_ < 0 ? -code_ : code_) - 1; }
    BOXWOOD_BOTH int turn() const { return code_ < 0 ? -1 : 1; }

  private:
    int code_ = 0;
};

/// The axes that span a coordinate plane, by the axis dropped.
struct PlaneAxes {
    int u, v;
};
inline constexpr PlaneAxes plane_axes[3] = {{1, 2}, {2, 0}, {0, 1}};

/// A triangle's corners, turned for the interval test (guigue_devillers.h).
struct Turned {
    Corner p, q, r;
};

/// The signs that decide a pair. sides() is what is known at no great cost, decided_sides() the
/// most that can be known. What cannot be decided is `unknown`, `maybe`, `undecided`.
template <class S>
concept PairSigns = requires(S& s, int i, Corner c, Turned t) {
    { s.sides(i) } -> std::same_as<Sides>; ///< of the other's corners to triangle i's plane
    { s.decided_sides(i) } -> std::same_as<Sides>;
    { s.project(i, Projection()) } -> std::same_as<Projection>; ///< like that one if it will do
    { s.overlap_along_line(t, t) } -> std::same_as<Answer>;     ///< see overlap_by_orient3d
    { s.orient3d(c, c, c, c) } -> std::same_as<int>;
    { s.orient2d(i, c, c, c) } -> std::same_as<int>;         ///< with axis i dropped
    { s.overlap_in_plane(i, i, i) } -> std::same_as<Answer>; ///< see overlap_by_orient2d
    { s.point(c) } -> std::convertible_to<Vec3<typename S::Real>>;
};

/// Of turned triangles the intervals on the planes' common line: disjoint if
/// orient3d(q1, p2, p1, q2) or orient3d(p1, p2, r1, r2) is 1.
template <class S> BOXWOOD_BOTH Answer overlap_by_orient3d(S& s, const Turned& a, const Turned& b) {
    const int low = s.orient3d(a.q, b.p, a.p, b.q);
    if (low == 1)
        return Answer::no;
    const int high = s.orient3d(a.p, b.p, a.r, b.r);
    if (high == 1)
        return Answer::no;
    return low == undecided || high == undecided ? Answer::maybe : Answer::yes;
}

/// Of coplanar triangles that turn by these signs with an axis dropped: disjoint if the line of an
/// edge of one has all of the other strictly on its outside.
template <class S>
BOXWOOD_BOTH Answer overlap_by_orient2d(S& s, int dropped, const int (&turns)[2]) {
    Answer answer = Answer::yes;
    for (Corner t = 0; t < 6; t += 3)
        for (Corner i = 0; i < 3; ++i) {
            const int outside = -turns[t / 3];
            bool surely = true, perhaps = true;
            for (Corner j = 0; perhaps && j < 3; ++j) {
                const int side = s.orient2d(dropped, t + i, t + (i + 1) % 3, 3 - t + j);
                surely &= side == outside;
                perhaps = side == outside || side == undecided;
            }
            if (perhaps && surely)
                return Answer::no;
            if (perhaps)
                answer = Answer::maybe;
        }
    return answer;
}

/// s.project by s.orient2d, beginning with the axis `first`.
template <class S> BOXWOOD_BOTH Projection project_by_orient2d(S& s, int of, int first) {
    const Corner t = of == 0 ? 0 : 3;
    Projection none;
    for (int k = 0; k < 3; ++k) {
        const int axis = (first + k) % 3, turn = s.orient2d(axis, t, t + 1, t + 2);
        if (turn == 1 || turn == -1)
            return {axis, turn};
        if (turn == undecided)
            none = Projection::undecided();
    }
    return none;
}

template <class Real> BOXWOOD_BOTH int largest_axis(const Vec3<Real>& v) {
    const Real x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
    return x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
}

/// A pair as orientation predicates P see it, one determinant at a time.
template <OrientationPredicates P> class Signs {
  public:
    using Real = typename P::Real;

    Signs(const Triangle<Real>& a, const Triangle<Real>& b) : p_{a.a, a.b, a.c, b.a, b.b, b.c} {}

    Sides sides(int of) const {
        const Corner t = of == 0 ? 0 : 3, other = 3 - t;
        unsigned above = 0, below = 0, unknown = 0;
        for (Corner k = 0; k < 3; ++k) {
            const int sign = orient3d(t, t + 1, t + 2, other + k);
            above |= unsigned{sign == 1} << k;
            below |= unsigned{sign == -1} << k;
            unknown |= unsigned{sign == undecided} << k;
        }
        return {above, below, unknown};
    }
    Sides decided_sides(int of) const { return sides(of); }
    Projection project(int of, Projection like) const {
        const Corner t = of == 0 ? 0 : 3;
        const Vec3<Real> n = cross(p_[t + 1] - p_[t], p_[t + 2] - p_[t]);
        return project_by_orient2d(*this, of, like ? like.axis() : largest_axis(n));
    }
    Answer overlap_along_line(const Turned& a, const Turned& b) const {
        return overlap_by_orient3d(*this, a, b);
    }
    int orient3d(Corner a, Corner b, Corner c, Corner d) const {
        return P::orient3d(p_[a], p_[b], p_[c], p_[d]);
    }
    int orient2d(int dropped, Corner a, Corner b, Corner c) const {
        const int u = plane_axes[dropped].u, v = plane_axes[dropped].v;
        const auto at = [&](Corner k) { return Point2<Real>{p_[k][u], p_[k][v]}; };
        return P::orient2d(at(a), at(b), at(c));
    }
    Answer overlap_in_plane(int dropped, int turn_a, int turn_b) const {
        return overlap_by_orient2d(*this, dropped, {turn_a, turn_b});
    }
    Vec3<Real> point(Corner k) const { return p_[k]; }

  private:
    std::array<Vec3<Real>, 6> p_;
};

/// Triangle pairs that no two planes describe: coplanar ones, and those of which one is degenerate
/// (a segment or a point). Each is a convex hull of 1, 2 or 3 corners; the smaller decides the
/// case.
///   point   - any:       the point lies in the hull
///   segment - segment:   coplanar, and not separated within that plane
///   segment - triangle:  its line passes through the triangle, between its ends
///   within one plane:    projected on a coordinate plane, two convex polygons are disjoint iff the
///                        line of an edge of one of them parts them strictly
///   on one line:         the ranges overlap in lexicographic order, which no line reverses
template <PairSigns S> class FlatPair {
  public:
    /// Of two triangles without a degenerate one, for coplanar ones only.
    BOXWOOD_BOTH static Answer meet(S& signs) {
        const Projection of_a = signs.project(0, {}), of_b = signs.project(1, of_a);
        if (of_a && of_b && of_a.axis() == of_b.axis())
            return signs.overlap_in_plane(of_a.axis(), of_a.turn(), of_b.turn());
        FlatPair pair{signs};
        const Hull a = pair.hull(0, of_a), b = pair.hull(1, of_b);
        const bool yes = a.size <= b.size ? pair.meet(a, b) : pair.meet(b, a);
        return pair.unsure_ ? Answer::maybe : yes ? Answer::yes : Answer::no;
    }

  private:
    BOXWOOD_BOTH explicit FlatPair(S& signs) : signs_(signs) {}

    /// The corners that count: a segment as its ends in lexicographic order.
    struct Hull {
        Corner corners[3];
        std::size_t size;
        Projection projection;
        BOXWOOD_BOTH Corner operator[](std::size_t i) const { return corners[i]; }
    };

    /// A sign; undecided is read as 0, and the answer built on it is `maybe`.
    BOXWOOD_BOTH int known(int sign) {
        unsure_ |= sign == undecided;
        return sign == undecided ? 0 : sign;
    }
    BOXWOOD_BOTH int orient3d(Corner a, Corner b, Corner c, Corner d) {
        return known(signs_.orient3d(a, b, c, d));
    }
    BOXWOOD_BOTH int orient2d(int dropped, Corner a, Corner b, Corner c) {
        return known(signs_.orient2d(dropped, a, b, c));
    }

    /// Lexicographically.
    BOXWOOD_BOTH bool before(Corner a, Corner b) const {
        const auto p = signs_.point(a), q = signs_.point(b);
        for (int k = 0; k < 2; ++k)
            if (p[k] < q[k] || q[k] < p[k])
                return p[k] < q[k];
        return p.z < q.z;
    }
    BOXWOOD_BOTH bool same(Corner a, Corner b) const {
        const auto p = signs_.point(a), q = signs_.point(b);
        return p.x == q.x && p.y == q.y && p.z == q.z;
    }

    BOXWOOD_BOTH Hull hull(int of, Projection projection) {
        const Corner t = of == 0 ? 0 : 3;
        unsure_ |= projection.is_undecided();
        if (projection)
            return {{t, t + 1, t + 2}, 3, projection};
        Corner low = t, high = t;
        for (Corner k = t + 1; k < t + 3; ++k) {
            low = before(k, low) ? k : low;
            high = before(high, k) ? k : high;
        }
        return {{low, high, high}, same(low, high) ? std::size_t{1} : std::size_t{2}, {}};
    }

    /// a.size <= b.size.
    BOXWOOD_BOTH bool meet(const Hull& a, const Hull& b) {
        if (a.size == 3)
            return meet_in_plane(a, b);
        if (b.size == 3)
            return meet_triangle(a, b);
        if (b.size == 1)
            return same(a[0], b[0]);
        // b is a segment, a a segment or point (its own two ends): on b's line, or in a plane with
        // it.
        const Corner a0 = a[0], a1 = a[a.size - 1];
        int axis = axis_to_drop(b[0], b[1], a0);
        if (axis == collinear && a.size == 2)
            axis = axis_to_drop(b[0], b[1], a1);
        if (axis == collinear)
            return !before(b[1], a0) && !before(a1, b[0]);
        return orient3d(b[0], b[1], a0, a1) == 0 && !parted_by_segment(a, b, axis) &&
               !parted_by_segment(b, a, axis);
    }

    static constexpr int collinear = -1;
    BOXWOOD_BOTH int axis_to_drop(Corner a, Corner b, Corner c) {
        for (int axis = 0; axis < 3; ++axis)
            if (orient2d(axis, a, b, c) != 0)
                return axis;
        return collinear;
    }

    BOXWOOD_BOTH bool meet_in_plane(const Hull& a, const Hull& b) {
        const int axis = a.projection.axis();
        const int turn_b =
            axis == b.projection.axis() ? b.projection.turn() : orient2d(axis, b[0], b[1], b[2]);
        const Answer answer = signs_.overlap_in_plane(axis, a.projection.turn(), turn_b);
        unsure_ |= answer == Answer::maybe;
        return answer == Answer::yes;
    }

    /// A segment or point against a triangle.
    BOXWOOD_BOTH bool meet_triangle(const Hull& a, const Hull& b) {
        const int first = orient3d(b[0], b[1], b[2], a[0]);
        const int last = a.size == 1 ? first : orient3d(b[0], b[1], b[2], a[1]);
        if (first == 0 && last == 0)
            return !parted_by_triangle(b, a) && !parted_by_segment(a, b, b.projection.axis());
        if (first == last)
            return false;
        // The segment's line meets b's plane in one of the segment's points. Is that in b?
        const int u = orient3d(a[0], a[1], b[0], b[1]);
        const int v = orient3d(a[0], a[1], b[1], b[2]);
        const int w = orient3d(a[0], a[1], b[2], b[0]);
        return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    }

    /// Whether the line of an edge of triangle t has all of the other, in its plane, strictly on
    /// its outside.
    BOXWOOD_BOTH bool parted_by_triangle(const Hull& t, const Hull& other) {
        const int axis = t.projection.axis(), outside = -t.projection.turn();
        for (std::size_t i = 0; i < 3; ++i) {
            bool parted = true;
            for (std::size_t j = 0; parted && j < other.size; ++j)
                parted = orient2d(axis, t[i], t[(i + 1) % 3], other[j]) == outside;
            if (parted)
                return true;
        }
        return false;
    }

    /// The same for a segment, which has two outsides; a point parts nothing.
    BOXWOOD_BOTH bool parted_by_segment(const Hull& segment, const Hull& other, int axis) {
        if (segment.size == 1)
            return false;
        bool left = true, right = true;
        for (std::size_t j = 0; j < other.size; ++j) {
            const int side = orient2d(axis, segment[0], segment[1], other[j]);
            left &= side == 1;
            right &= side == -1;
        }
        return left || right;
    }

    S& signs_;
    bool unsure_ = false;
};

} // namespace boxwood::detail
