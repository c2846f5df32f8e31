#pragma once

#include "kernels/primitives/vec3.h"

#include <array>

namespace boxwood {

/// A box in any pose: the points centre + sum s_k half[k] axis[k], |s_k| <= 1. The axes are meant
/// to be orthonormal; as they are rounded, they need only be nearly so.
template <class Real> struct Obb {
    Vec3<Real> centre{};
    std::array<Vec3<Real>, 3> axis{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Vec3<Real> half{}; ///< half side lengths, scene units, >= 0

    constexpr bool operator==(const Obb&) const = default;
};

} // namespace boxwood
