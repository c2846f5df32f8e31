#pragma once

#include "trees/world/pose.h"

#include <algorithm>
#include <cmath>

namespace boxwood::detail {

/// A ball around all corners of a mesh, in its frame.
struct Ball {
    Vec3<double> centre;
    double radius = 0;
    double reach = 0; ///< at least |x|_1 of each corner x
};

/// Whether two balls, b moved by `pose`, are certainly more than `gap` apart: the 30 products that
/// decide most pairs of meshes whose boxes along the axes overlap. |R|^2 is at most the
/// greatest row sum of |R R^T|. Corners that are moved in doubles are off by
/// less than 2^-50 of what they are made of. False, too, where a number is not finite or beyond
/// 2^61, or that sum is no rotation's.
inline bool are_parted(const Ball& a, const Ball& b, const Pose& pose, double gap = 0) {
    const auto& [r0, r1, r2] = pose.rotation;
    const double xy = std::abs(dot(r0, r1)), xz = std::abs(dot(r0, r2)), yz = std::abs(dot(r1, r2));
    const double stretch =
        std::max({dot(r0, r0) + xy + xz, dot(r1, r1) + xy + yz, dot(r2, r2) + xz + yz});
    const Vec3<double> t = pose(b.centre) - a.centre;
    const Vec3<double>& from = pose.translation;
    const double rounding = 0x1p-48 * (a.reach + (1 + stretch) * b.reach + std::abs(from.x) +
                                       std::abs(from.y) + std::abs(from.z));
    // sqrt(x) <= (1 + x) / 2
    const double least = a.radius + 0.5 * (1 + stretch) * b.radius + gap + rounding;
    const double squared = dot(t, t);
    return squared > least * least * (1 + 0x1p-40) && squared < 0x1p122 &&
           std::abs(stretch - 1) < 0x1p-11;
}

} // namespace boxwood::detail
