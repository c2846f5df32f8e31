#pragma once

#include "kernels/primitives/aabb.h"

#include <algorithm>
#include <cmath>

namespace boxwood::detail {

/// At most the distance of two boxes: three differences, their squares, sum and root round eight
/// times in all, each by 2^-53 of the result at most. Squares below 2^-1022 may be lost: then it is
/// 0, as for boxes that overlap.
inline double gap_below(const Aabb<double>& a, const Aabb<double>& b) {
    Vec3<double> apart;
    for (int axis = 0; axis < 3; ++axis)
        apart[axis] = std::max({0.0, a.min[axis] - b.max[axis], b.min[axis] - a.max[axis]});
    const double square = dot(apart, apart);
    return square < 0x1p-1000 ? 0 : std::sqrt(std::min(square, 0x1p1020)) * (1 - 8 * 0x1p-53);
}

} // namespace boxwood::detail
