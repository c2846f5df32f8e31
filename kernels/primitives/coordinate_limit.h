#pragma once

#include "kernels/primitives/vec3.h"

#include <cmath>

namespace boxwood {

/// Coordinates, sizes and margins of bodies, robots, and meshes that are held against one another
/// are below it: products of two of them are finite in floats. (MeshBvh takes rays and points to
/// meshes below 2^126.)
inline constexpr double coordinate_limit = 0x1p60;

/// Whether all three are numbers below it.
template <class T> bool is_in_range(const Vec3<T>& v) {
    constexpr T limit = static_cast<T>(coordinate_limit);
    return std::abs(v.x) < limit && std::abs(v.y) < limit && std::abs(v.z) < limit;
}

} // namespace boxwood
