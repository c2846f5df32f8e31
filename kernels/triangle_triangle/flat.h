#pragma once

#include "kernels/predicates/orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace boxwood {

/// Asks P and remembers whether a sign came back undecided (it is then read as 0, and the answer
/// built on it is `maybe`).
template <OrientationPredicates P> class Signs {
  public:
    int orient3d(Vec3<double> a, Vec3<double> b, Vec3<double> c, Vec3<double> d) {
        return known(P::orient3d(a, b, c, d));
    }
    int orient2d(Point2<double> a, Point2<double> b, Point2<double> c) {
        return known(P::orient2d(a, b, c));
    }
    bool unsure() const { return unsure_; }

  private:
    int known(int sign) {
        if (sign != undecided)
            return sign;
        unsure_ = true;
        return 0;
    }
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
template <OrientationPredicates P> class FlatPair {
  public:
    using Corners = std::array<Vec3<double>, 3>;

    static bool meet(Signs<P>& signs, const Corners& a, const Corners& b) {
        const Hull ha = hull(signs, a), hb = hull(signs, b);
        return ha.size <= hb.size ? meet(signs, ha, hb) : meet(signs, hb, ha);
    }

  private:
    /// The corners that count: a segment as its ends in lexicographic order. `axis` is the one to
    /// drop from a triangle (`collinear` else).
    struct Hull {
        Corners corners;
        std::size_t size;
        int axis;
        Vec3<double> operator[](std::size_t i) const { return corners[i]; }
    };

    static bool before(const Vec3<double>& p, const Vec3<double>& q) {
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    }

    static Point2<double> project(Vec3<double> p, int dropped) {
        return dropped == 0   ? Point2<double>{p.y, p.z}
               : dropped == 1 ? Point2<double>{p.z, p.x}
                              : Point2<double>{p.x, p.y};
    }

    static constexpr int collinear = -1;

    /// The axis to drop so that the plane of a, b, c is projected one to one, or `collinear`. The
    /// largest component of the normal is asked first; any whose sign is not zero is right.
    static int axis_to_drop(Signs<P>& signs, Vec3<double> a, Vec3<double> b, Vec3<double> c) {
        const Vec3<double> n = cross(b - a, c - a);
        const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
        const int largest = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
        for (int k = 0; k < 3; ++k) {
            const int axis = (largest + k) % 3;
            if (signs.orient2d(project(a, axis), project(b, axis), project(c, axis)) != 0)
                return axis;
        }
        return collinear;
    }

    static Hull hull(Signs<P>& signs, const Corners& t) {
        const int axis = axis_to_drop(signs, t[0], t[1], t[2]);
        if (axis != collinear)
            return {t, 3, axis};
        const auto [low, high] = std::minmax_element(t.begin(), t.end(), before);
        return {{*low, *high, *high}, *low == *high ? std::size_t{1} : std::size_t{2}, axis};
    }

    /// a.size <= b.size.
    static bool meet(Signs<P>& signs, const Hull& a, const Hull& b) {
        if (b.size == 3)
            return meet_triangle(signs, a, b);
        if (b.size == 1)
            return a[0] == b[0];
        // b is a segment, a a segment or point (its own two ends): on b's line, or in a plane with
        // it.
        const Vec3<double> a0 = a[0], a1 = a[a.size - 1];
        int axis = axis_to_drop(signs, b[0], b[1], a0);
        if (axis == collinear && a.size == 2)
            axis = axis_to_drop(signs, b[0], b[1], a1);
        if (axis == collinear)
            return !before(b[1], a0) && !before(a1, b[0]);
        return signs.orient3d(b[0], b[1], a0, a1) == 0 && !separated(signs, a, b, axis);
    }

    static bool meet_triangle(Signs<P>& signs, const Hull& a, const Hull& b) {
        if (a.size == 3) // two triangles come here only if coplanar
            return !separated(signs, a, b, b.axis);
        const int first = signs.orient3d(b[0], b[1], b[2], a[0]);
        const int last = a.size == 1 ? first : signs.orient3d(b[0], b[1], b[2], a[1]);
        if (first == 0 && last == 0)
            return !separated(signs, a, b, b.axis);
        // The segment's ends do not lie strictly on one side: its line meets b's plane in one of
        // its points. Is that in b?
        const int u = signs.orient3d(a[0], a[1], b[0], b[1]);
        const int v = signs.orient3d(a[0], a[1], b[1], b[2]);
        const int w = signs.orient3d(a[0], a[1], b[2], b[0]);
        return std::min({u, v, w}) >= 0 || std::max({u, v, w}) <= 0;
    }

    /// Whether the line of an edge of one strictly parts the two, both in one plane.
    static bool separated(Signs<P>& signs, const Hull& a, const Hull& b, int axis) {
        return parted_by_edge(signs, a, b, axis) || parted_by_edge(signs, b, a, axis);
    }

    static bool parted_by_edge(Signs<P>& signs, const Hull& a, const Hull& b, int axis) {
        const std::size_t edges = a.size == 3 ? 3 : 1;
        for (std::size_t i = 0; i < edges; ++i) {
            // The inside of edge i; a segment has none and parts on either side, a point never.
            const Point2<double> p = project(a[i], axis), q = project(a[(i + 1) % a.size], axis);
            const int inside = a.size < 3 ? 0 : signs.orient2d(p, q, project(a[(i + 2) % 3], axis));
            const int side = signs.orient2d(p, q, project(b[0], axis));
            bool parted = side != 0 && side != inside;
            for (std::size_t j = 1; parted && j < b.size; ++j)
                parted = signs.orient2d(p, q, project(b[j], axis)) == side;
            if (parted)
                return true;
        }
        return false;
    }
};

} // namespace boxwood
