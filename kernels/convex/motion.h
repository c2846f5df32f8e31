#pragma once

#include "kernels/convex/shapes.h"

namespace boxwood::convex {

/// A rigid motion while t goes from 0 to 1. The pose at t: what is at x at the start is at
///   centre + t velocity + R(t) (x - centre),   R(t) the rotation by t spin.
struct Motion {
    Pose start;
    Vec3<double> velocity{};
    Vec3<double> spin{};   ///< axis times angle, radians, in the world
    Vec3<double> centre{}; ///< of the rotation, at the start
};

/// The pose at t, rounded: points are off by less than motion_error.
Pose pose_at(const Motion& motion, double t);

/// From one pose to another: the frame's origin moves along a line, and turns at constant speed, by
/// at most pi. Where it ends is `to` up to rounding.
Motion linear_motion(const Pose& from, const Pose& to);
/// The same with the origin on a helix: a turn about one axis and a shift along it.
Motion screw_motion(const Pose& from, const Pose& to);

namespace detail {
/// How far pose_at may put a point of a shape that reaches this far: the angle is off by 4u of
/// itself, sine and cosine by 2u, entries of the rotation by 8u and of the product by 12u, together
/// less than 48u of a point's distance from the centre and 8u of that times the angle; the sums by
/// less than 8u of the lengths added.
double motion_error(const Motion& motion, double reach);
} // namespace detail

} // namespace boxwood::convex
