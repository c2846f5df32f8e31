#pragma once

#include "kernels/primitives/triangle.h"

#include <array>
#include <cstddef>

namespace boxwood::detail {

/// Two triangles for separating-axis tests: corners from a's first one, edges, normals.
struct SatPair {
    using Vector = Vec3<double>;
    std::array<Vector, 3> a, b; ///< corners; a[0] = 0
    std::array<Vector, 3> edges_a, edges_b;
    Vector normal_a, normal_b;

    SatPair(const Triangle<double>& p, const Triangle<double>& q)
        : a{Vector{}, p.b - p.a, p.c - p.a}, b{q.a - p.a, q.b - p.a, q.c - p.a},
          edges_a{a[1], p.c - p.b, p.a - p.c}, edges_b{q.b - q.a, q.c - q.b, q.a - q.c},
          normal_a(cross(edges_a[0], edges_a[1])), normal_b(cross(edges_b[0], edges_b[1])) {}
};

/// Whether `separates` holds for one of the axes that suffice; stops at the first that does:
///   not coplanar, of rank 2:  both normals and the 9 crosses of edges, which come first
///   coplanar:                 the 6 edge normals in the plane too (17 axes in all)
///   one of rank 0 or 1:       the same, with the normal of the other
///   both of rank 0 or 1:      the segments' common normal, and the normals to either within it
///   ... with no such normal:  parallel segments, or points: along them, across them to the other
/// A zero axis may be offered: it separates nothing.
template <class Separates> bool any_axis(const SatPair& pair, Separates&& separates) {
    using Vector = Vec3<double>;
    const Vector zero{};
    if (separates(pair.normal_a) || separates(pair.normal_b))
        return true;
    Vector common{}, along{};
    for (const Vector& e : pair.edges_a)
        for (const Vector& f : pair.edges_b) {
            const Vector axis = cross(e, f);
            if (separates(axis))
                return true;
            common = axis == zero ? common : axis;
            along = e != zero ? e : f != zero ? f : along;
        }
    Vector plane_a = pair.normal_a, plane_b = pair.normal_b;
    if (plane_a == zero && plane_b == zero)
        plane_a = plane_b = common;
    else if (plane_a == zero)
        plane_a = plane_b;
    else if (plane_b == zero)
        plane_b = plane_a;
    if (plane_a == zero) {
        const Vector between = pair.b[0];
        return separates(along) ||
               separates(along == zero ? between : cross(along, cross(between, along)));
    }
    for (const Vector& e : pair.edges_a)
        if (separates(cross(plane_a, e)))
            return true;
    for (const Vector& f : pair.edges_b)
        if (separates(cross(plane_b, f)))
            return true;
    return false;
}

} // namespace boxwood::detail
