#pragma once

#include "trees/world/pose.h"

#include <cmath>

namespace boxwood::detail {

/// Around all corners of a mesh, in its frame.
struct BoundingSphere {
    Vec3<double> centre;
    double radius = 0;
    double reach = 0; ///< at least |x|_1 of each corner x
};

/// Whether two spheres, b moved by `pose`, are certainly more than `gap` apart: the 30 products
/// that decide most pairs of meshes whose boxes along the axes overlap. |R|^2 exceeds 1 by no more
/// than the sum of all |R R^T - I|. Corners that are moved in doubles are off by less than 2^-50 of
/// what they are made of. False, too, where R is off orthonormal by 2^-12 or more, and where the
/// pose has a number that is not finite or beyond 2^62.
[[gnu::always_inline]] inline bool are_separated(const BoundingSphere& a, const BoundingSphere& b,
                                                 const Pose& pose, double gap) {
    const auto& [r0, r1, r2] = pose.rotation;
    const double skew =
        (std::abs(dot(r0, r0) - 1) + std::abs(dot(r1, r1) - 1) + std::abs(dot(r2, r2) - 1)) +
        2 * (std::abs(dot(r0, r1)) + std::abs(dot(r0, r2)) + std::abs(dot(r1, r2)));
    const Vec3<double> t = pose(b.centre) - a.centre;
    const Vec3<double>& from = pose.translation;
    const double rounding =
        0x1p-48 * (a.reach + b.reach + std::abs(from.x) + std::abs(from.y) + std::abs(from.z));
    const double reach = a.radius + (1 + skew) * b.radius + gap + rounding;
    const double squared = dot(t, t);
    return squared > reach * reach * (1 + 0x1p-40) && squared < 0x1p120 && skew < 0x1p-12;
}

} // namespace boxwood::detail
