#pragma once

#include "kernels/convex/signed_distance.h"

#include <array>

namespace boxwood::convex {

/// Midway between the two surfaces, and how deep: negative where they are that far apart.
struct ContactPoint {
    Vec3<double> point{};
    double depth = 0;
};

/// Where two shapes meet: at most four points, the deepest first, all along one normal.
struct Contacts {
    std::array<ContactPoint, 4> points;
    int count = 0;
    SignedDistance distance; ///< with the normal, from a to b
};

/// The contacts of shapes that are at most `margin` apart, else none. Where a face of a box lies
/// against a box: the corners of the other's face cut to it; of what lies on a half-space or plane,
/// the corners of boxes, hulls and triangles, the ends of capsules, points of the rims of cylinders
/// and cones; of those within the margin the deepest and three that span most; off by rounding. Of
/// all other pairs the deepest point alone.
Contacts contacts(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                  double margin = 0);

} // namespace boxwood::convex
