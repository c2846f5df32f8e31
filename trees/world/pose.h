#pragma once

#include "kernels/primitives/rotation.h"

#include <span>

namespace boxwood {

/// Where a body is: x -> rotation x + translation, in doubles.
using Pose = RigidTransform<double>;

/// The pose with the rotation nearest to its matrix. Throws std::invalid_argument where a number is
/// not finite or beyond 2^60, the matrix is off a rotation by more than 1e-3, or it is a
/// reflection.
Pose checked_pose(const Pose& pose);

/// From the 16 numbers of a 4 x 4 matrix, row by row, the last row 0, 0, 0, 1. Throws
/// std::invalid_argument for others, and as checked_pose.
Pose pose_of_matrix(std::span<const double, 16> m);

/// The pose of B as seen from A: x -> A^-1 B x. Both as checked_pose gives them.
Pose relative_pose(const Pose& a, const Pose& b);

} // namespace boxwood
