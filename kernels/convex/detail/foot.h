#pragma once

#include "kernels/convex/detail/gjk.h"

/// Closed forms of a point against a shape, in the shape's frame.
namespace boxwood::convex::detail {

/// Where the surface is nearest to a point: signed distance (negative inside), and the direction in
/// which the point leaves the shape. The distance is off by at most width, and 16u (|p| + reach) by
/// the count of roundings of lengths no longer than that.
struct Foot {
    double distance;
    Vec3<double> point, normal;
    double width = 0; ///< more than rounding only where a search ended early
};

/// v of length d made a unit vector, any one if it is 0.
inline Vec3<double> over(Vec3<double> v, double d) {
    return d > 0 ? v * (1 / d) : Vec3<double>{1, 0, 0};
}

[[gnu::always_inline]] inline Foot foot(Vec3<double> p, Point) {
    const double d = length(p);
    return {d, {}, over(p, d)};
}

/// Of the segment from -half_length axis to half_length axis.
[[gnu::always_inline]] inline Foot foot_on_rod(Vec3<double> p, Vec3<double> axis,
                                               double half_length) {
    const double t = std::clamp(dot(p, axis) / dot(axis, axis), -half_length, half_length);
    const Vec3<double> on = axis * t, away = p - on;
    const double d = length(away);
    const double size = norm1(p) + half_length * norm1(axis);
    if (d <= 0x1p-20 * size) [[unlikely]] {
        // Of a point on the rod the direction is all rounding: the way out is square to the axis.
        const Vec3<double> square = away - axis * (dot(away, axis) / dot(axis, axis));
        const double across = length(square);
        if (std::abs(t) < half_length && across > .5 * d)
            return {d, on, over(square, across)};
        if (std::abs(t) < half_length || d <= 0x1p-48 * size)
            return {d, on, unit_or(square_to(axis), {1, 0, 0})};
    }
    return {d, on, over(away, d)};
}
[[gnu::always_inline]] inline Foot foot(Vec3<double> p, Rod rod) {
    return foot_on_rod(p, {0, 0, 1}, rod.half_length);
}

[[gnu::always_inline]] inline Foot foot(Vec3<double> p, const Box& s) {
    const Vec3<double> on = min(max(p, -s.half), s.half), away = p - on;
    if (const double d = length(away); d > 0)
        return {d, on, over(away, d)};
    int k = 0;
    double most = -inf;
    for (int i = 0; i < 3; ++i)
        if (const double out = std::abs(p[i]) - s.half[i]; out > most)
            most = out, k = i;
    Foot f{most, p, {}};
    f.point[k] = std::copysign(s.half[k], p[k]);
    f.normal[k] = std::copysign(1.0, p[k]);
    return f;
}

/// A point of the half plane in which a solid of revolution has its profile.
struct Flat {
    double across, z;
};

/// Turns the foot in the half plane through p into one in space.
[[gnu::always_inline]] inline Foot revolved(Vec3<double> p, double across, double distance, Flat on,
                                            Flat normal) {
    const double x = across > 0 ? p.x / across : 1, y = across > 0 ? p.y / across : 0;
    return {distance,
            {x * on.across, y * on.across, on.z},
            {x * normal.across, y * normal.across, normal.z}};
}

[[gnu::always_inline]] inline Foot foot(Vec3<double> p, const Cylinder& s) {
    const double across = std::sqrt(p.x * p.x + p.y * p.y);
    const double side = across - s.radius, end = std::abs(p.z) - s.half_length;
    const double up = std::copysign(1.0, p.z);
    if (side > 0 && end > 0) {
        const double d = std::sqrt(side * side + end * end);
        return revolved(p, across, d, {s.radius, up * s.half_length}, {side / d, up * (end / d)});
    }
    if (side > end)
        return revolved(p, across, side, {s.radius, p.z}, {1, 0});
    return revolved(p, across, end, {across, up * s.half_length}, {0, up});
}

/// The profile is the triangle of the axis, the base and the slant from apex to rim.
[[gnu::always_inline]] inline Foot foot(Vec3<double> p, const Cone& s) {
    const double across = std::sqrt(p.x * p.x + p.y * p.y), below = -s.half_length - p.z;
    const double from_apex = p.z - s.half_length;
    const double slant = std::sqrt(s.radius * s.radius + 4 * s.half_length * s.half_length);
    if (!(slant > 0))
        return foot(p, Point{});
    if (!(s.half_length > 0)) // without an inside what is beside no face may be outside
        return foot(p, Cylinder{s.radius, 0});
    if (!(s.radius > 0))
        return foot(p, Rod{s.half_length});
    const Flat down{s.radius / slant, -2 * s.half_length / slant}, out{-down.z, down.across};
    const double beside = across * out.across + from_apex * out.z;
    const double along = across * down.across + from_apex * down.z;
    const double t = std::clamp(along, 0.0, slant);
    const Flat on_slant{t * down.across, s.half_length + t * down.z};
    const Flat on_base{std::min(across, s.radius), -s.half_length};
    if (beside <= 0 && below <= 0)
        return beside > below ? revolved(p, across, beside, on_slant, out)
                              : revolved(p, across, below, on_base, {0, -1});
    // Beside a face its own normal, which does not cancel where the point is near.
    if (beside > 0 && along > 0 && along < slant)
        return revolved(p, across, beside, on_slant, out);
    if (below > 0 && across <= s.radius)
        return revolved(p, across, below, on_base, {0, -1});
    Foot best{inf, {}, {}};
    for (const bool base : {false, true}) {
        if (base ? !(below > 0) : !(beside > 0))
            continue;
        const Flat on = base ? on_base : on_slant;
        const double x = across - on.across, z = p.z - on.z, d = std::sqrt(x * x + z * z);
        if (d < best.distance)
            best = revolved(p, across, d, on,
                            d > 0  ? Flat{x / d, z / d}
                            : base ? Flat{0, -1}
                                   : out);
    }
    return best;
}

/// By a search, ellipsoid_foot.h.
Foot foot(Vec3<double> p, const Ellipsoid& s);
/// As deep in the core as in the ellipsoid less the ball.
inline Foot foot(Vec3<double> p, const EllipsoidCore& s) {
    Foot f = foot(p, Ellipsoid{s.radii});
    f.distance += s.ball;
    f.point = f.point - f.normal * s.ball;
    return f;
}

} // namespace boxwood::convex::detail
