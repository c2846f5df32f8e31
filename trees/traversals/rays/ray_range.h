#pragma once

#include "kernels/primitives/ray.h"
#include "trees/tree.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace boxwood::detail {

/// Refuses triangles beyond the range of the kernels. bounds: of all of them, not empty.
inline void require_ray_range(const Box& bounds) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::max(std::abs(bounds.min[axis]), std::abs(bounds.max[axis])) <
              max_ray_coordinate))
            throw std::invalid_argument("rays: the mesh has a coordinate that is not below 2^126 "
                                        "(8.5e37) in size, the range of the ray kernels");
}

} // namespace boxwood::detail
