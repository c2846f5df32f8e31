#pragma once

#include "kernels/arithmetic/on_both.h"
#include "kernels/primitives/aabb.h"

#include <cstdint>

namespace boxwood {

/// The largest float <= x. Monotone. NaN stays NaN, and zeros keep their sign.
/// Beyond the floats: x > FLT_MAX (finite) gives FLT_MAX, x < -FLT_MAX gives -inf.
/// Needs flush-to-zero off. A factor (1 - eps) would fail at zero and among the denormals.
BOXWOOD_BOTH inline float round_down(double x) {
    // Without a branch, which would be mispredicted half of the time: floats of one sign are in the
    // order of their bits, of negative ones reversed; a zero that is too high is -0.
    const float nearest = static_cast<float>(x);
    const auto bits = bits_as<std::int32_t>(nearest);
    const int too_high = static_cast<double>(nearest) > x;
    return bits_as<float>(bits - too_high * (bits >> 31 | 1));
}

/// The smallest float >= x: -round_down(-x). Finite x > FLT_MAX gives +inf, x < -FLT_MAX -FLT_MAX.
BOXWOOD_BOTH inline float round_up(double x) { return -round_down(-x); }

/// The smallest float box that contains `box`; the empty box stays empty. As both roundings are
/// monotone and outward, every overlap and containment between boxes (or of points that are floats)
/// is kept; boxes less than an ulp apart may come to overlap.
BOXWOOD_BOTH inline Aabb<float> round_outward(const Aabb<double>& box) {
    return {{round_down(box.min.x), round_down(box.min.y), round_down(box.min.z)},
            {round_up(box.max.x), round_up(box.max.y), round_up(box.max.z)}};
}

} // namespace boxwood
