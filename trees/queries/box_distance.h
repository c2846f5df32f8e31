#pragma once

#include "kernels/primitives/aabb.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood {

/// The square of the distance from a point to a closed box, 0 inside; all finite. The differences
/// are rounded once, to double, so that the result is off by less than 5 * 2^-53 of itself; it is
/// exact where the coordinates are multiples of 2^-k below 2^(25-k). Of floats it neither over- nor
/// underflows.
template <class Real, class PointReal = float>
BOXWOOD_BOTH double squared_distance(Vec3<PointReal> point, const Aabb<Real>& box) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double p = static_cast<double>(point[axis]);
        const double below = static_cast<double>(box.min[axis]) - p,
                     above = p - static_cast<double>(box.max[axis]);
        const double beside = below < above ? above : below, d = beside < 0 ? 0 : beside;
        sum += d * d;
    }
    return sum;
}

namespace detail {

/// A float below which distances in a tree are bounded: squares of lengths times the power of two
/// `scale`, at which they neither over- nor underflow. A bound from below is taken smaller by the
/// share `share` and by `min_error`, one from above larger: rounding in floats moves neither across
/// the true value (its relative error is below 6 * 2^-24, that of a denormal square below 2^-148).
struct DistanceScale {
    static constexpr float share = 0x1p-20f, min_error = 0x1p-120f;

    float scale = 1;

    /// For one point and all boxes within the bounds.
    template <class Real> DistanceScale(Vec3<float> point, const Aabb<Real>& bounds) {
        double reach = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double p = static_cast<double>(point[axis]);
            reach = std::max({reach, p - static_cast<double>(bounds.min[axis]),
                              static_cast<double>(bounds.max[axis]) - p});
        }
        if (reach > 0x1p10 || (reach > 0 && reach < 0x1p-10))
            scale = std::ldexp(1.0f, std::clamp(-std::ilogb(reach), -120, 120));
    }

    /// At most the squared distance, scaled; at least 0.
    float below(double squared) const {
        const double s = static_cast<double>(scale);
        const float scaled = static_cast<float>(std::min(squared * s * s, 0x1p126));
        return std::max(0.0f, scaled * (1 - share) - min_error);
    }
    /// At least the squared distance, scaled.
    float above(double squared) const {
        const double s = static_cast<double>(scale);
        const double scaled = squared * s * s;
        constexpr float inf = std::numeric_limits<float>::infinity();
        return scaled < 0x1p120 ? static_cast<float>(scaled) * (1 + share) + min_error : inf;
    }
};

} // namespace detail
} // namespace boxwood
