#pragma once

#include "kernels/ray_box/ray_box_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood {

/// The slab test of a ray against many boxes within known bounds, one fused product and difference
/// per plane: near * entry_rdir - entry_shift. A SIMD version computes `clip` from these numbers,
/// fused or not.
///
/// Why no true hit is lost, u = 2^-24. Take d > 0 (d < 0 mirrors it), a box within bounds, and a
/// hit at t with near <= o + d t. entry_rdir = (1 - 12u) / d, thrice rounded, is at most
/// (1 - 8u) / d, so (near - o) entry_rdir <= t (1 - 8u), or it is negative: void. entry_shift is
/// at least o entry_rdir + u |near| entry_rdir, the latter for a product that is rounded on its
/// own: `pad` holds 4u (|o| + |near|) entry_rdir, of which the roundings of the shift take at most
/// 3u |o| entry_rdir. So the difference is at most t before its last rounding, and that is
/// monotone. The exit mirrors it. What this costs: planes move by a few ulp of the coordinates.
///
/// Components smaller than 2^-22 of the largest count as that: within the bounds such a ray moves
/// across by at most 2^-22 reach, t <= reach / largest, which T = 2 reach / largest of slack in
/// entry and 2 T in exit holds, zero components included.
///
/// `margin` is that of ray_margin (slabs.h) for float triangle kernels: entry is made earlier and
/// exit later by it; of its 16u reach / largest they need 5u, the roundings of the shifts 4u.
struct FusedSlabs {
    Vec3<float> entry_rdir, entry_shift, exit_rdir, exit_shift;

    /// bounds: those of all boxes to come.
    FusedSlabs(const Ray<float>& ray, const Aabb<float>& bounds) {
        const Vec3<float> low = bounds.min - ray.origin, high = bounds.max - ray.origin;
        float largest = 0, reach = 0, coordinate = 0;
        for (int k = 0; k < 3; ++k) {
            largest = std::max(largest, std::abs(ray.direction[k]));
            reach = std::max({reach, std::abs(low[k]), std::abs(high[k])});
            coordinate = std::max({coordinate, std::abs(ray.origin[k]), std::abs(bounds.min[k]),
                                   std::abs(bounds.max[k])});
        }
        const float per_largest = 1 / largest, least = 0x1p-22f * largest;
        // Nothing below overflows. Else (or for NaN) no box is missed.
        if (!(coordinate * per_largest < 0x1p100f && largest > 0x1p-100f &&
              coordinate < 0x1p124f)) {
            give_up(ray);
            return;
        }
        const float beyond = 2 * reach * per_largest;
        // 2^-146: what underflows in denormal coordinates.
        const float margin = (0x1p-20f * reach + 0x1p-147f) * per_largest + 0x1p-146f;
        for (int k = 0; k < 3; ++k) {
            const float size = std::abs(ray.direction[k]);
            const bool small = !(size >= least);
            const float r = std::copysign(1 / (small ? least : size), ray.direction[k]);
            const float widest = std::max(std::abs(bounds.min[k]), std::abs(bounds.max[k]));
            entry_rdir[k] = r * (1 - 0x1.8p-21f);
            exit_rdir[k] = r * (1 + 0x1.8p-21f);
            const float in = ray.origin[k] * entry_rdir[k], out = ray.origin[k] * exit_rdir[k];
            const float pad = 0x1p-22f * (std::abs(out) + widest * std::abs(exit_rdir[k]));
            entry_shift[k] = in + pad + (margin + (small ? beyond : 0));
            exit_shift[k] = out - pad - (margin + (small ? 2 * beyond : 0));
        }
    }

  private:
    /// Entries below 0 and exits beyond everything, but the empty box (+inf, -inf) stays empty.
    void give_up(const Ray<float>& ray) {
        constexpr float least = std::numeric_limits<float>::min();
        for (int k = 0; k < 3; ++k) {
            entry_rdir[k] = exit_rdir[k] = std::copysign(least, ray.direction[k]);
            entry_shift[k] = 8; // |near| entry_rdir < 4
            exit_shift[k] = -std::numeric_limits<float>::max();
        }
    }
};

/// Clips [t_min, t_max], t_min >= 0, by a box within the bounds or the empty box; near and far by
/// the sign bit of entry_rdir. Never misses, as clip(RaySlabs ...).
inline RaySpan clip(const FusedSlabs& ray, const Aabb<float>& box, float t_min, float t_max) {
    for (int k = 0; k < 3; ++k) {
        const bool negative = std::signbit(ray.entry_rdir[k]);
        const float near = negative ? box.max[k] : box.min[k];
        const float far = negative ? box.min[k] : box.max[k];
        t_min = std::max(t_min, std::fma(near, ray.entry_rdir[k], -ray.entry_shift[k]));
        t_max = std::min(t_max, std::fma(far, ray.exit_rdir[k], -ray.exit_shift[k]));
    }
    return {t_min, t_max};
}

} // namespace boxwood
