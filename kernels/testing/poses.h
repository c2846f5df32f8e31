#pragma once

#include "kernels/primitives/obb.h"
#include "kernels/primitives/rotation.h"

#include <array>
#include <cmath>
#include <random>

/// Random boxes and rotations for the tests of this folder.
namespace boxwood {

class RandomPoses {
  public:
    explicit RandomPoses(std::uint64_t seed) : bits_(seed) {}

    std::uint64_t bits() { return bits_(); }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(bits_); }
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(bits_);
    }
    /// 2^low .. 2^high, either sign.
    double any_size(double low, double high) {
        return std::exp2(real(low, high)) * (bits() % 2 ? 1 : -1);
    }
    Vec3<double> vector(double size) {
        return {real(-size, size), real(-size, size), real(-size, size)};
    }
    Vec3<double> unit_vector() {
        for (;;) {
            const Vec3<double> v = vector(1);
            if (const double l = length(v); l > 0.1 && l < 1)
                return v * (1 / l);
        }
    }

    /// Rows (or columns) of a rotation, orthonormal up to rounding.
    std::array<Vec3<double>, 3> rotation() { return rotation(unit_vector(), real(0, 6.3)); }
    static std::array<Vec3<double>, 3> rotation(Vec3<double> axis, double angle) {
        const double s = std::sin(angle / 2), w = std::cos(angle / 2);
        const double x = axis.x * s, y = axis.y * s, z = axis.z * s;
        return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                 {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                 {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
    }

  private:
    std::mt19937_64 bits_;
};

template <class Real> std::array<Vec3<Real>, 3> rounded(const std::array<Vec3<double>, 3>& m) {
    return {static_cast<Vec3<Real>>(m[0]), static_cast<Vec3<Real>>(m[1]),
            static_cast<Vec3<Real>>(m[2])};
}

} // namespace boxwood
