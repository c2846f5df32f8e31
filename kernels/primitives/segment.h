#pragma once

#include "kernels/primitives/vec3.h"

namespace boxwood {

/// The closed segment from a to b; a point if they are equal.
template <class Real> struct Segment {
    Vec3<Real> a, b;

    constexpr bool operator==(const Segment&) const = default;
};

} // namespace boxwood
