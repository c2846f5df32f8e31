#pragma once

#include "kernels/primitives/vec3.h"
#include "scenes/sampling/random.h"

#include <cmath>
#include <cstdint>

namespace boxwood {

/// Smooth noise in [0, 1): random values at the integer points, blended by the cubic 3t^2 - 2t^3.
inline double lattice_noise(const Random& random, Vec3<double> p) {
    const Vec3<double> low{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const Vec3<double> t = p - low;
    const auto smooth = [](double u) { return u * u * (3 - 2 * u); };
    const Vec3<double> s{smooth(t.x), smooth(t.y), smooth(t.z)};
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        std::uint64_t item = 0;
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const int step = corner >> axis & 1;
            const auto coordinate = static_cast<std::int64_t>(low[axis]) + step + (1 << 20);
            item = item << 21 | static_cast<std::uint64_t>(coordinate);
            weight *= step ? s[axis] : 1 - s[axis];
        }
        sum += weight * random.item(item).uniform();
    }
    return sum;
}

} // namespace boxwood
