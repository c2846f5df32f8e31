#pragma once

#include "kernels/arithmetic/rounding.h"
#include "kernels/boxes/fit.h"

#include <array>
#include <cmath>
#include <limits>

namespace boxwood::bench {

/// What stays of the fitted box of a body while nothing turns it: that of PaddedFit, whose every
/// rounding comes in the same turn, so that `at` gives the bits of `fitted_box`. Needs
/// flush-to-zero off.
struct TurnedBox {
    Vec3<double> centre, half, size; ///< Rc, |R|e, |R||c|

    TurnedBox(const std::array<Vec3<double>, 3>& rotation, const Aabb<float>& rest) {
        const CentredBox<double> in(static_cast<Aabb<double>>(rest));
        for (int i = 0; i < 3; ++i) {
            const Vec3<double> row = rotation[static_cast<std::size_t>(i)];
            centre[i] = dot(row, in.centre);
            half[i] = dot(magnitudes(row), in.half);
            size[i] = dot(magnitudes(row), magnitudes(in.centre));
        }
    }
    /// Of a body that never turned.
    BOXWOOD_BOTH explicit TurnedBox(const Aabb<float>& rest) {
        const CentredBox<double> in(static_cast<Aabb<double>>(rest));
        centre = in.centre;
        half = in.half;
        size = magnitudes(in.centre);
    }

    BOXWOOD_BOTH Aabb<float> at(const Vec3<double>& translation) const {
        Aabb<double> box;
        for (int i = 0; i < 3; ++i) {
            const double all = size[i] + std::abs(translation[i]) + half[i];
            const double reach = half[i] + (eight_u * all + least);
            const bool known = all <= most;
            box.min[i] = known ? centre[i] + translation[i] - reach : -Aabb<double>::inf;
            box.max[i] = known ? centre[i] + translation[i] + reach : Aabb<double>::inf;
        }
        return round_outward(box);
    }

  private:
    using Limits = std::numeric_limits<double>;
    // Functions of the host, which a device cannot call.
    static constexpr double most = Limits::max(), eight_u = 4 * Limits::epsilon();
    static constexpr double least = 4 * Limits::denorm_min();
};

} // namespace boxwood::bench
