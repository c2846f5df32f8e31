#pragma once

#include "kernels/primitives/vec3.h"

#include <algorithm>
#include <cmath>

namespace boxwood::convex {

/// A half-space or plane by a normal of length 1, up to rounding.
struct UnitFlat {
    Vec3<double> normal;
    double offset;
};

/// NaN for a normal of 0, or one that is not finite.
template <class S> UnitFlat unit_flat(const S& flat) {
    const double squared = dot(flat.normal, flat.normal);
    if (squared > 0x1p-900 && squared < 0x1p900) [[likely]] {
        const double scale = 1 / std::sqrt(squared);
        return {flat.normal * scale, flat.offset * scale};
    }
    // The square may over- or underflow: by a power of two first, which is exact.
    const Vec3<double>& n = flat.normal;
    const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
    const int exponent = std::isfinite(largest) && largest > 0 ? -std::ilogb(largest) : 0;
    const Vec3<double> near_one{std::ldexp(n.x, exponent), std::ldexp(n.y, exponent),
                                std::ldexp(n.z, exponent)};
    const double scale = 1 / length(near_one);
    return {near_one * scale, std::ldexp(flat.offset, exponent) * scale};
}

} // namespace boxwood::convex
