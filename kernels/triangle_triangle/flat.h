#pragma once

#include "kernels/predicates/orientation.h"
#include "kernels/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <tuple>

namespace boxwood {

/// A corner of a pair of triangles: 0, 1, 2 of the first, 3, 4, 5 of the second.
using Corner = std::size_t;

/// On which side of a triangle's plane the other's corners lie: bit k for the other's corner k. On
/// the plane is neither; `unknown` was not decided.
struct Sides {
    unsigned above = 0, below = 0, unknown = 0;

    bool strictly_one_side() const { return above == 7 || below == 7; }
    bool all_on_plane() const { return (above | below | unknown) == 0; }
};

/// The coordinate plane (the axis to drop, 0 .. 2) that a triangle is projected on one to one, and
/// the sign of its turn there. No axis: it is degenerate.
struct Projection {
    int axis = none;
    int turn = 0;
    static constexpr int none = -1;
};

/// The signs that decide a pair. What it cannot decide, orient3d calls `undecided`; orient2d and
/// project read it as 0 and set unsure(). Axes u, v span the plane that orient2d means.
template <class S>
concept PairSigns = requires(S& s, int i, Corner c) {
    { s.sides(i) } -> std::same_as<Sides>; ///< of the other's corners to triangle i's plane
    { s.project(i) } -> std::same_as<Projection>;
    { s.orient3d(c, c, c, c) } -> std::same_as<int>;
    { s.orient2d(i, c, c, c) } -> std::same_as<int>; ///< with axis i dropped
    { s.point(c) } -> std::convertible_to<Vec3<typename S::Real>>;
    { s.unsure() } -> std::same_as<bool>;
};

/// A pair as orientation predicates P see it, one determinant at a time.
template <OrientationPredicates P> class Signs {
  public:
    using Real = typename P::Real;

    Signs(const Triangle<Real>& a, const Triangle<Real>& b) : p_{a.a, a.b, a.c, b.a, b.b, b.c} {}

    Sides sides(int of) const {
        const Corner t = of == 0 ? 0 : 3, other = 3 - t;
        Sides s;
        for (Corner k = 0; k < 3; ++k) {
            const int sign = orient3d(t, t + 1, t + 2, other + k);
            s.above |= unsigned{sign == 1} << k;
            s.below |= unsigned{sign == -1} << k;
            s.unknown |= unsigned{sign == undecided} << k;
        }
        return s;
    }
    /// The largest component of the normal is asked first; any whose sign is not zero is right.
    Projection project(int of) {
        const Corner t = of == 0 ? 0 : 3;
        const Vec3<Real> n = cross(p_[t + 1] - p_[t], p_[t + 2] - p_[t]);
        const Real x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
        const int largest = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
        for (int k = 0; k < 3; ++k) {
            const int axis = (largest + k) % 3;
            if (const int turn = orient2d(axis, t, t + 1, t + 2); turn != 0)
                return {axis, turn};
        }
        return {};
    }
    int orient3d(Corner a, Corner b, Corner c, Corner d) const {
        return P::orient3d(p_[a], p_[b], p_[c], p_[d]);
    }
    int orient2d(int dropped, Corner a, Corner b, Corner c) {
        const int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
        const auto at = [&](Corner k) { return Point2<Real>{p_[k][u], p_[k][v]}; };
        const int sign = P::orient2d(at(a), at(b), at(c));
        unsure_ |= sign == undecided;
        return sign == undecided ? 0 : sign;
    }
    Vec3<Real> point(Corner k) const { return p_[k]; }
    bool unsure() const { return unsure_; }

  private:
    std::array<Vec3<Real>, 6> p_;
    bool unsure_ = false;
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
    /// Of two triangles without a degenerate one, only coplanar ones may be asked.
    static Answer meet(S& signs) {
        FlatPair pair{signs};
        const Hull a = pair.hull(0), b = pair.hull(1);
        const bool yes = a.size <= b.size ? pair.meet(a, b) : pair.meet(b, a);
        return pair.unsure_ || signs.unsure() ? Answer::maybe : yes ? Answer::yes : Answer::no;
    }

  private:
    explicit FlatPair(S& signs) : signs_(signs) {}

    /// The corners that count: a segment as its ends in lexicographic order.
    struct Hull {
        std::array<Corner, 3> corners;
        std::size_t size;
        Projection projection;
        Corner operator[](std::size_t i) const { return corners[i]; }
    };

    bool before(Corner a, Corner b) const {
        const auto p = signs_.point(a), q = signs_.point(b);
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    }
    bool same(Corner a, Corner b) const { return signs_.point(a) == signs_.point(b); }

    Hull hull(int of) {
        const Corner t = of == 0 ? 0 : 3;
        const Projection projection = signs_.project(of);
        if (projection.axis != Projection::none)
            return {{t, t + 1, t + 2}, 3, projection};
        Corner low = t, high = t;
        for (const Corner k : {t + 1, t + 2}) {
            low = before(k, low) ? k : low;
            high = before(high, k) ? k : high;
        }
        return {{low, high, high}, same(low, high) ? std::size_t{1} : std::size_t{2}, {}};
    }

    int orient3d(Corner a, Corner b, Corner c, Corner d) {
        const int sign = signs_.orient3d(a, b, c, d);
        unsure_ |= sign == undecided;
        return sign == undecided ? 0 : sign;
    }

    /// a.size <= b.size.
    bool meet(const Hull& a, const Hull& b) {
        if (b.size == 3)
            return meet_triangle(a, b);
        if (b.size == 1)
            return same(a[0], b[0]);
        // b is a segment, a a segment or point (its own two ends): on b's line, or in a plane with
        // it.
        const Corner a0 = a[0], a1 = a[a.size - 1];
        int axis = axis_to_drop(b[0], b[1], a0);
        if (axis == Projection::none && a.size == 2)
            axis = axis_to_drop(b[0], b[1], a1);
        if (axis == Projection::none)
            return !before(b[1], a0) && !before(a1, b[0]);
        return orient3d(b[0], b[1], a0, a1) == 0 && !parted_by_edge(a, b, axis) &&
               !parted_by_edge(b, a, axis);
    }

    int axis_to_drop(Corner a, Corner b, Corner c) {
        for (const int axis : {0, 1, 2})
            if (signs_.orient2d(axis, a, b, c) != 0)
                return axis;
        return Projection::none;
    }

    bool meet_triangle(const Hull& a, const Hull& b) {
        if (a.size == 3) {
            const auto [axis, turn] = b.projection;
            return !parted_by_edge(b, turn, a, axis) &&
                   !parted_by_edge(a, turn_along(axis, a), b, axis);
        }
        const int first = orient3d(b[0], b[1], b[2], a[0]);
        const int last = a.size == 1 ? first : orient3d(b[0], b[1], b[2], a[1]);
        if (first == 0 && last == 0)
            return !parted_by_edge(b, b.projection.turn, a, b.projection.axis) &&
                   !parted_by_edge(a, b, b.projection.axis);
        if (first == last)
            return false;
        // The segment's line meets b's plane in one of the segment's points. Is that in b?
        const int u = orient3d(a[0], a[1], b[0], b[1]);
        const int v = orient3d(a[0], a[1], b[1], b[2]);
        const int w = orient3d(a[0], a[1], b[2], b[0]);
        return std::min({u, v, w}) >= 0 || std::max({u, v, w}) <= 0;
    }

    int turn_along(int axis, const Hull& t) {
        return axis == t.projection.axis ? t.projection.turn
                                         : signs_.orient2d(axis, t[0], t[1], t[2]);
    }

    /// Whether the line of an edge of triangle t has all of the other strictly on its outside. No
    /// branch on a sign: they are as good as random.
    bool parted_by_edge(const Hull& t, int turn, const Hull& other, int axis) {
        bool parted = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const Corner p = t[i], q = t[i == 2 ? 0 : i + 1];
            bool outside = true;
            for (std::size_t j = 0; j < 3; ++j)
                outside &= signs_.orient2d(axis, p, q, other[j]) == -turn;
            parted |= outside;
        }
        return parted;
    }

    /// The same for a segment, which has two outsides; a point parts nothing.
    bool parted_by_edge(const Hull& segment, const Hull& other, int axis) {
        if (segment.size == 1)
            return false;
        bool left = true, right = true;
        for (std::size_t j = 0; j < other.size; ++j) {
            const int side = signs_.orient2d(axis, segment[0], segment[1], other[j]);
            left &= side == 1;
            right &= side == -1;
        }
        return left || right;
    }

    S& signs_;
    bool unsure_ = false;
};

} // namespace boxwood
