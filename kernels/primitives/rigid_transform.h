#pragma once

#include "kernels/primitives/vec3.h"

#include <array>

namespace boxwood {

/// x -> rotation x + translation. rotation holds the rows of the matrix; any finite numbers.
template <class Real> struct RigidTransform {
    std::array<Vec3<Real>, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Vec3<Real> translation{};

    constexpr bool operator==(const RigidTransform&) const = default;

    /// The image of p, rounded.
    constexpr Vec3<Real> operator()(Vec3<Real> p) const { return rotated(p) + translation; }
    /// That of a direction.
    constexpr Vec3<Real> rotated(Vec3<Real> v) const {
        return {dot(rotation[0], v), dot(rotation[1], v), dot(rotation[2], v)};
    }
};

} // namespace boxwood
