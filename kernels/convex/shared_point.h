#pragma once

#include "kernels/convex/shapes.h"

namespace boxwood::convex {

/// A point of the triangle that is one of the shape, too, up to rounding (2^-44 of the size of all,
/// as of signed_distance), where the two share one; else the point of it where the shape is
/// nearest. Poses as of signed_distance.
Vec3<double> shared_point(const Triangle& a, const Pose& pose_a, const Shape& b,
                          const Pose& pose_b);

} // namespace boxwood::convex
