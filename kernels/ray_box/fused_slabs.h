#pragma once

#include "kernels/ray_box/ray_box_kernel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace boxwood {

/// Axes x, y, z in lanes 0, 1, 2; lane 3 means nothing.
using Float4 = float __attribute__((vector_size(16)));

/// What FusedSlabs needs of the bounds of all boxes to come, made once for many rays.
struct SlabBounds {
    Float4 min{}, max{}, widest{}; ///< widest: the larger of |min| and |max|
    float coordinate = 0;          ///< the largest of `widest`

    explicit SlabBounds(const Aabb<float>& box) {
        for (int k = 0; k < 3; ++k) {
            min[k] = box.min[k];
            max[k] = box.max[k];
            widest[k] = std::max(std::abs(min[k]), std::abs(max[k]));
            coordinate = std::max(coordinate, widest[k]);
        }
    }
};

/// The slab test of a ray against many boxes within known bounds, one fused product and difference
/// per plane: near * rdir - entry_shift. A SIMD version computes `clip` from these numbers, fused
/// or not; nine of them, and the ray's range, leave registers free where there are sixteen.
///
/// Why no true hit is lost, u = 2^-24. Take d > 0 (d < 0 mirrors it), a box within bounds, and a
/// hit at t with near <= o + d t. rdir = (1 + e) / d, |e| <= u, so (near - o) rdir is at most
/// t + u (|near| + |o|) rdir (1 + 2u). A product that is rounded on its own adds u |near| rdir, and
/// the roundings of the shift take 3u |o| rdir, up to 6u of `pad` itself and 3u of `margin`: `pad`
/// holds 6u (|o| + |near|) rdir for these 4u and 2u. So the difference is at most t before its last
/// rounding, and that is monotone. The exit mirrors it. What this costs: planes move by a few ulp
/// of the coordinates.
///
/// Components smaller than 2^-22 of the largest count as that: within the bounds such a ray moves
/// across by at most 2^-22 reach, t <= reach / largest, which T = 2 reach / largest of slack in
/// entry and 2 T in exit holds, zero components included, and what makes t late or early by less
/// than reach / (2 largest).
///
/// `margin` is for the sake of `Watertight`, as in RaySlabs (slabs.h): entry is made earlier and
/// exit later by it. Of its 16u reach / largest the kernel's roundings need 5u, those of the shifts
/// 4u. What underflows in the kernel, 2^-150 (reach + 1) / |d|, is at most 2^-128 (reach + 1) /
/// largest: less than u reach / largest, and the 2^-127.
struct FusedSlabs {
    Float4 rdir, entry_shift, exit_shift;

    FusedSlabs() = default; ///< of no ray yet
    [[gnu::always_inline]] FusedSlabs(const Ray<float>& ray, const SlabBounds& bounds) {
        const Float4 origin{ray.origin.x, ray.origin.y, ray.origin.z, 0};
        const Float4 direction{ray.direction.x, ray.direction.y, ray.direction.z, 0};
        const Float4 size = abs(direction);
        const Float4 low = abs(bounds.min - origin), high = abs(bounds.max - origin);
        const float largest = largest_of(size);
        const float reach = largest_of(low > high ? low : high);
        const float coordinate = std::max(largest_of(abs(origin)), bounds.coordinate);
        const float per_largest = 1 / largest, min_direction = 0x1p-22f * largest;
        // Nothing below overflows. Else (or for NaN) no box is missed.
        if (!(coordinate * per_largest < 0x1p100f && largest > 0x1p-100f &&
              coordinate < 0x1p124f)) {
            give_up(direction);
            return;
        }
        const float beyond = 2 * reach * per_largest;
        // 2^-146: what underflows here.
        const float margin = (0x1p-20f * reach + 0x1p-127f) * per_largest + 0x1p-146f;
        const auto small = size < min_direction;
        rdir = with_sign(1 / (small ? all(min_direction) : size), direction);
        const Float4 at = origin * rdir;
        const Float4 pad = 0x1.8p-22f * (abs(at) + bounds.widest * abs(rdir));
        entry_shift = at + pad + (small ? all(margin + beyond) : all(margin));
        exit_shift = at - pad - (small ? all(margin + 2 * beyond) : all(margin));
    }

  private:
    using Bits = std::int32_t __attribute__((vector_size(16)));

    static Bits bits_of(Float4 x) { return std::bit_cast<Bits>(x); }
    static Float4 of_bits(Bits x) { return std::bit_cast<Float4>(x); }
    static Float4 all(float x) { return Float4{x, x, x, x}; }
    static Float4 abs(Float4 x) { return of_bits(bits_of(x) & 0x7fffffff); }
    /// x >= 0 with the signs of y.
    static Float4 with_sign(Float4 x, Float4 y) {
        return of_bits(bits_of(x) | (bits_of(y) & std::numeric_limits<std::int32_t>::min()));
    }
    static float largest_of(Float4 x) { return std::max(std::max(x[0], x[1]), x[2]); }

    /// Entries below 0 and exits beyond everything, but the empty box (+inf, -inf) stays empty.
    void give_up(Float4 direction) {
        rdir = with_sign(all(std::numeric_limits<float>::min()), direction);
        entry_shift = all(8); // |near| rdir < 4
        exit_shift = all(-std::numeric_limits<float>::max());
    }
};

/// Clips [t_min, t_max], t_min >= 0, by a box within the bounds or the empty box; near and far by
/// the sign bit of rdir. Never misses, as clip(RaySlabs ...).
inline RaySpan clip(const FusedSlabs& ray, const Aabb<float>& box, float t_min, float t_max) {
    for (int k = 0; k < 3; ++k) {
        const bool negative = std::signbit(ray.rdir[k]);
        const float near = negative ? box.max[k] : box.min[k];
        const float far = negative ? box.min[k] : box.max[k];
        t_min = std::max(t_min, std::fma(near, ray.rdir[k], -ray.entry_shift[k]));
        t_max = std::min(t_max, std::fma(far, ray.rdir[k], -ray.exit_shift[k]));
    }
    return {t_min, t_max};
}

} // namespace boxwood
