#pragma once

#include "kernels/primitives/rotation.h"

#include <cstddef>
#include <span>
#include <type_traits>

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

/// What has a matrix linear() and a vector translation(), as Eigen's Isometry3d, Affine3d and
/// Isometry3f have. Eigen itself is not needed here.
template <class T>
concept HasLinearAndTranslation = requires(const T& t) {
    static_cast<double>(t.linear()(0, 0));
    static_cast<double>(t.translation()[0]);
};

/// From such a transform. Throws as checked_pose.
template <HasLinearAndTranslation Transform> Pose pose_of(const Transform& transform) {
    Pose pose;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            pose.rotation[static_cast<std::size_t>(row)][column] =
                static_cast<double>(transform.linear()(row, column));
        pose.translation[row] = static_cast<double>(transform.translation()[row]);
    }
    return checked_pose(pose);
}

/// As such a transform: transform_of<Eigen::Isometry3d>(pose).
template <HasLinearAndTranslation Transform> Transform transform_of(const Pose& pose) {
    Transform transform = Transform::Identity();
    using Number = std::remove_cvref_t<decltype(transform.linear()(0, 0))>;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            transform.linear()(row, column) =
                static_cast<Number>(pose.rotation[static_cast<std::size_t>(row)][column]);
        transform.translation()[row] = static_cast<Number>(pose.translation[row]);
    }
    return transform;
}

/// The pose of B as seen from A: x -> A^-1 B x. Both as checked_pose gives them.
Pose relative_pose(const Pose& a, const Pose& b);

} // namespace boxwood
