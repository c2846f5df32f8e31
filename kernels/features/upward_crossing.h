#pragma once

#include "kernels/predicates/exact.h"
#include "kernels/primitives/triangle.h"
#include "kernels/triangle_triangle/exact.h"

#include <cstdint>

namespace boxwood {

/// How a point sees a closed triangle above it.
enum class Crossing : std::uint8_t {
    none,
    crosses, ///< the ray upwards from the point crosses it
    touches  ///< the point lies on it
};

namespace detail {

/// On which side of a, b the point p lies in the x-y plane, once it has moved by (e, e * e) for an
/// e > 0 as small as need be: 1 to the left, -1 to the right, 0 only if a and b are one.
inline int side_once_moved(Vec3<double> a, Vec3<double> b, Vec3<double> p) {
    if (const int side = Exact::orient2d({a.x, a.y}, {b.x, b.y}, {p.x, p.y}))
        return side;
    if (a.y != b.y)
        return a.y < b.y ? -1 : 1;
    return (a.x < b.x) - (b.x < a.x);
}

} // namespace detail

/// Exact, for finite points. The ray stands an infinitely small way (e, e * e) beside the point, so
/// that it meets no edge and no vertex, and crosses no triangle that is upright or degenerate: of a
/// closed surface that does not touch the point it crosses an odd number of triangles if the point
/// is inside, an even one if it is outside. Source: Edelsbrunner, Muecke 1990, "Simulation of
/// Simplicity".
inline Crossing upward_crossing(Vec3<double> p, const Triangle<double>& t) {
    const int above = Exact::orient3d(t.a, t.b, t.c, p);
    if (above == 0 && GuigueDevillersExact::intersect(t, {p, p, p}).answer == Answer::yes)
        return Crossing::touches;
    const int turn = detail::side_once_moved(t.a, t.b, p);
    if (turn == 0 || detail::side_once_moved(t.b, t.c, p) != turn ||
        detail::side_once_moved(t.c, t.a, p) != turn)
        return Crossing::none;
    return above == -turn ? Crossing::crosses : Crossing::none;
}

} // namespace boxwood
