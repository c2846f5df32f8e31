#pragma once

#include "kernels/convex/shapes.h"
#include "kernels/primitives/aabb.h"

#include <cmath>
#include <limits>
#include <type_traits>

/// The farthest point of a shape in a direction, and what follows from it: the least and greatest
/// extent along a direction and the box of a posed shape.
namespace boxwood::convex {

namespace detail {

inline constexpr double u = std::numeric_limits<double>::epsilon() / 2;
inline constexpr double inf = std::numeric_limits<double>::infinity();

/// The core of a sphere: its centre.
struct Point {};
/// The core of a capsule: its segment.
struct Rod {
    double half_length;
};

inline Vec3<double> support(Point, Vec3<double>) { return {}; }
inline Vec3<double> support(Rod r, Vec3<double> d) {
    return {0, 0, std::copysign(r.half_length, d.z)};
}

/// The core of an ellipsoid: what the centre of a ball reaches that rolls inside of it. The rounder
/// the ellipsoid, the less is left for a search to go around.
struct EllipsoidCore {
    Vec3<double> radii; ///< of the ellipsoid
    double ball; ///< its radius: at most the least radius of curvature, so that all is reached
};
inline double rolling_radius(const Ellipsoid& s) {
    const double least = std::min({s.radii.x, s.radii.y, s.radii.z});
    const double most = std::max({s.radii.x, s.radii.y, s.radii.z});
    return least > 0 ? least * (least / most) * (1 - 8 * u) : 0;
}
inline Vec3<double> support(const EllipsoidCore& s, Vec3<double> d) {
    const Vec3<double> e{s.radii.x * d.x, s.radii.y * d.y, s.radii.z * d.z};
    const double size = length(e);
    if (!(size > 0))
        return {};
    const double scale = 1 / size, back = s.ball / length(d);
    return {s.radii.x * (e.x * scale) - back * d.x, s.radii.y * (e.y * scale) - back * d.y,
            s.radii.z * (e.z * scale) - back * d.z};
}

/// Every shape is its core and all that is at most radius_of(shape) from it.
inline Point core(const Sphere&) { return {}; }
inline Rod core(const Capsule& s) { return {s.half_length}; }
inline EllipsoidCore core(const Ellipsoid& s) { return {s.radii, rolling_radius(s)}; }
template <BoundedShape S> const S& core(const S& s) { return s; }
inline double radius_of(const Sphere& s) { return s.radius; }
inline double radius_of(const Capsule& s) { return s.radius; }
inline double radius_of(const Ellipsoid& s) { return rolling_radius(s); }
template <class S> double radius_of(const S&) { return 0; }

/// At least the greatest distance of a core's points from the origin of its frame.
inline double reach(Point) { return 0; }
inline double reach(Rod r) { return r.half_length; }
inline double reach(const Box& s) { return s.half.x + s.half.y + s.half.z; }
inline double reach(const Cylinder& s) { return s.radius + s.half_length; }
inline double reach(const Cone& s) { return s.radius + s.half_length; }
inline double reach(const EllipsoidCore& s) { return (s.radii.x + s.radii.y + s.radii.z) - s.ball; }
inline double reach(const Hull& s) { return s.reach(); }
[[gnu::always_inline]] inline double norm1(Vec3<double> p) {
    return std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
}
inline double reach(const Triangle& s) {
    const double a = norm1(s.a), b = norm1(s.b), c = norm1(s.c);
    return std::max({a, b, c}) + 0 * (a + b + c); // NaN of any of them
}

/// At most the radius of the greatest ball around the origin that a core holds. Of hulls and
/// triangles, which need not hold it, there is none.
inline double inner_radius(Point) { return 0; }
inline double inner_radius(Rod) { return 0; }
inline double inner_radius(const Box& s) { return std::min({s.half.x, s.half.y, s.half.z}); }
inline double inner_radius(const Cylinder& s) { return std::min(s.radius, s.half_length); }
inline double inner_radius(const Cone& s) {
    const double slant = std::sqrt(4 * s.half_length * s.half_length + s.radius * s.radius);
    return slant > 0 ? s.half_length * std::min(1.0, s.radius / slant * (1 - 8 * u)) : 0;
}
inline double inner_radius(const EllipsoidCore& s) {
    return std::max(0.0, std::min({s.radii.x, s.radii.y, s.radii.z}) * (1 - 8 * u) - s.ball);
}

} // namespace detail

/// A point of the shape whose product with d is the greatest, up to 8u of |d| times what the shape
/// spans from its origin; it is that near to the shape. d is finite, between 2^-400 and 2^400 in
/// size, or 0: then any point.
inline Vec3<double> support(const Box& s, Vec3<double> d) {
    return {std::copysign(s.half.x, d.x), std::copysign(s.half.y, d.y),
            std::copysign(s.half.z, d.z)};
}
inline Vec3<double> support(const Cylinder& s, Vec3<double> d) {
    const double across = std::sqrt(d.x * d.x + d.y * d.y), z = std::copysign(s.half_length, d.z);
    if (!(across > 0))
        return {0, 0, z};
    const double scale = s.radius / across;
    return {d.x * scale, d.y * scale, z};
}
inline Vec3<double> support(const Cone& s, Vec3<double> d) {
    const double across = std::sqrt(d.x * d.x + d.y * d.y);
    if (2 * s.half_length * d.z >= s.radius * across)
        return {0, 0, s.half_length};
    if (!(across > 0))
        return {0, 0, -s.half_length};
    const double scale = s.radius / across;
    return {d.x * scale, d.y * scale, -s.half_length};
}
inline Vec3<double> support(const Ellipsoid& s, Vec3<double> d) {
    const Vec3<double> e{s.radii.x * d.x, s.radii.y * d.y, s.radii.z * d.z};
    const double size = length(e);
    if (!(size > 0))
        return {};
    const double scale = 1 / size;
    return {s.radii.x * (e.x * scale), s.radii.y * (e.y * scale), s.radii.z * (e.z * scale)};
}
inline Vec3<double> support(const Hull& s, Vec3<double> d) {
    const std::span<const Vec3<double>> points = s.points();
    std::size_t best = 0;
    double most = -detail::inf;
    for (std::size_t i = 0; i < points.size(); ++i) { // without a branch that is hard to foresee
        const double x = dot(points[i], d);
        const bool is_farther = x > most;
        most = is_farther ? x : most;
        best = is_farther ? i : best;
    }
    return best < points.size() ? points[best] : Vec3<double>{};
}
inline Vec3<double> support(const Triangle& s, Vec3<double> d) {
    const double a = dot(s.a, d), b = dot(s.b, d), c = dot(s.c, d);
    return a >= b ? (a >= c ? s.a : s.c) : b >= c ? s.b : s.c;
}
inline Vec3<double> support(const Sphere& s, Vec3<double> d) {
    const double size = length(d);
    return size > 0 ? d * (s.radius / size) : Vec3<double>{};
}
inline Vec3<double> support(const Capsule& s, Vec3<double> d) {
    return support(detail::Rod{s.half_length}, d) + support(Sphere{s.radius}, d);
}

namespace detail {
using convex::support;
}

/// What a shape's points are at least and at most along a direction.
struct Extent {
    double least = 0, greatest = 0;
};

/// Certified: least <= d . p <= greatest for all points p of the posed shape, p as the doubles of
/// the pose say; off by at most 40u |d|_1 (|translation|_1 + reach). |d| within 2^-200 to 2^200.
/// Half-spaces and planes: infinite on every side that they do not close off for sure.
Extent extent_along(const Shape& shape, const Pose& pose, Vec3<double> d);

/// A box that holds the posed shape, no side off by more than 40u (|translation|_1 + reach).
Aabb<double> bounds(const Shape& shape, const Pose& pose);

} // namespace boxwood::convex
