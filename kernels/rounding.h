#pragma once

#include "kernels/aabb.h"

#include <cmath>
#include <limits>

namespace boxwood {

/// The largest float <= x. Monotone. NaN stays NaN, and zeros keep their sign.
/// Beyond the floats: x > FLT_MAX (finite) gives FLT_MAX, x < -FLT_MAX gives -inf.
/// Needs flush-to-zero off. A factor (1 - eps) would fail at zero and among the denormals.
inline float round_down(double x) {
    const float nearest = static_cast<float>(x);
    return static_cast<double>(nearest) > x
               ? std::nextafter(nearest, -std::numeric_limits<float>::infinity())
               : nearest;
}

/// The smallest float >= x: -round_down(-x). Finite x > FLT_MAX gives +inf, x < -FLT_MAX -FLT_MAX.
inline float round_up(double x) {
    const float nearest = static_cast<float>(x);
    return static_cast<double>(nearest) < x
               ? std::nextafter(nearest, std::numeric_limits<float>::infinity())
               : nearest;
}

/// The smallest float box that contains `box`; the empty box stays empty. As both roundings are
/// monotone and outward, every overlap and containment between boxes (or of points that are floats)
/// is kept; boxes less than an ulp apart may overlap anew.
inline Aabb<float> round_outward(const Aabb<double>& box) {
    return {{round_down(box.min.x), round_down(box.min.y), round_down(box.min.z)},
            {round_up(box.max.x), round_up(box.max.y), round_up(box.max.z)}};
}

} // namespace boxwood
