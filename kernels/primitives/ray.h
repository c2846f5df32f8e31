#pragma once

#include "kernels/primitives/vec3.h"

#include <cstdint>
#include <limits>

namespace boxwood {

/// The points origin + t * direction with t_min <= t <= t_max, where t_min >= 0. The direction need
/// not be of unit length, is not zero, and its components may be +0 or -0. A t_max of infinity is
/// no limit but that of float: every ray ends where t rounds to more than the largest float, 2^128.
template <class Real> struct Ray {
    Vec3<Real> origin, direction;
    Real t_min = 0;
    Real t_max = std::numeric_limits<Real>::infinity();
};

/// Rays at meshes: vertices and origins are below this in size, so that no difference overflows.
inline constexpr float max_ray_coordinate = 0x1p126f;

inline constexpr std::uint32_t no_triangle = 0xffffffffu;

/// Where a ray meets a triangle (a, b, c): at origin + t * direction, which is
/// (1 - u - v) a + u b + v c up to the kernel's error; of a hit all three are finite. A miss has
/// triangle == no_triangle.
struct RayHit {
    static constexpr float nowhere = std::numeric_limits<float>::infinity();

    float t = nowhere;
    float u = 0, v = 0;
    std::uint32_t triangle = no_triangle;

    BOXWOOD_BOTH constexpr bool hit() const { return triangle != no_triangle; }
    constexpr bool operator==(const RayHit&) const = default;
};

} // namespace boxwood
