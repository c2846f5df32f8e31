#pragma once

#include "kernels/arithmetic/rounding.h"
#include "kernels/ray_box/ray_box_kernel.h"

#include <cmath>
#include <limits>

namespace boxwood {

/// What the slab test needs of a ray, made once per ray. A SIMD version that repeats the arithmetic
/// of `clip`, operation for operation, from these numbers keeps its promise.
///
/// Why no true hit is lost, u = 2^-24. Take an axis with d > 0 (d < 0 mirrors it) and a true entry
/// a = (near - o) / d >= 0. The subtraction gives (near - o)(1 + e), |e| <= u / (1 + u), without
/// underflow. With entry_rdir <= 1 / (d (1 + u)) the real product (near - o)(1 + e) entry_rdir is
/// <= a; likewise with exit_rdir >= (1 + u) / d the one for the exit b is >= b. Rounding is
/// monotone, so a <= b gives fl(product_a) <= fl(product_b), even where a product under- or
/// overflows, and the same against the floats t_min and t_max. Where a < 0 the comparison with
/// t_min >= 0 makes it void, and the sign of a product is right.
/// Raising 1 / d of the exit by 2 ulp alone is refuted (slabs_test.cpp). Scaling the exit by
/// 1 + 2 gamma_3 costs a product per box and still fails where 1 / d is denormal or overflows.
///
/// The slack is 8u, not u, and with bounds there is more (see below) for the sake of `Watertight`.
///
/// With the bounds of all triangles to come no triangle that `Watertight` hits is lost. Why, in the
/// terms of watertight.h: corners at (X_i, Y_i, Z_i) from the origin, |Z_i| <= reach. The kernel
/// finds weights w_i >= 0 of corners moved by e_i across and f_i along the ray,
///
///   sum w_i (X_i - s Z_i + e_i) = 0,   t d_z = sum w_i (Z_i + f_i),
///   so t d_x = sum w_i (X_i + e_i + s f_i),
///   where |e_i| <= 2u |X_i| + 4u |s| reach + 2^-150 (reach + 1), |f_i| <= u |Z_i|:
///
/// t is within 5u reach / |d_z| + 2^-150 (reach + 1) / |d_x| of the slab of the X_i (1 +- 2u),
/// which the slack of 8u holds;
/// likewise in y, and in z without any of it. Entry and exit may so part by twice that. Where the
/// second term is within 2u reach / |d_z|, that is 14u reach / |d_z|, and `margin` is 16u: room for
/// the rounding of t and here; 2^-147 stands for what underflows in denormal coordinates. Where it
/// is more (the shear, or what it multiplies, is next to denormal), the axis clips nothing.
struct RaySlabs {
    static constexpr std::string_view name = "slabs";
    static constexpr KernelInfo info{
        "ray_box",
        name,
        "slab test, near and far planes by sign bit, reciprocals padded so that no true hit is "
        "lost",
        Promise::never_miss,
        "entry low and exit high by at most 14u relative, u = 2^-24: 8u of slack, 2u for the "
        "reciprocal, 3u of roundings (derived in slabs.h)",
        "6 subtractions, 6 products"};

    Vec3<float> origin;
    Vec3<float> entry_rdir; ///< 1 / direction, rounded towards zero with the slack above
    Vec3<float> exit_rdir;  ///< 1 / direction, rounded away from zero
    bool negative[3];       ///< signbit(direction): the near plane is box.max
    float margin;           ///< every entry is made earlier by this t

    BOXWOOD_BOTH explicit RaySlabs(const Ray<float>& ray) : origin(ray.origin), margin(0) {
        constexpr double slack = 0x1p-21; // a zero component gives +-inf twice all the same
        for (int k = 0; k < 3; ++k) {
            const float d = ray.direction[k];
            const double size = std::abs(static_cast<double>(d));
            // With |o| < 2^103 near - o cannot overflow for a finite box. Beyond it the entry is
            // given up: entry_rdir = 0 makes it 0 (or NaN, which is skipped).
            const bool exact = std::abs(origin[k]) < 0x1p103f;
            float entry, exit;
            if (size > 0x1p-100 && size < 0x1p100) {
                // No reciprocal under- or overflows: 2u more slack covers the rounding to float,
                // and those of the quotient and product.
                const double r = 1 / size;
                entry = static_cast<float>(r * (1 - slack - 0x1p-23));
                exit = static_cast<float>(r * (1 + slack + 0x1p-23));
            } else {
                entry = round_down((1 - slack) / size);
                exit = round_up((1 + slack) / size);
            }
            entry_rdir[k] = std::copysign(exact ? entry : 0.0f, d);
            exit_rdir[k] = std::copysign(exit, d);
            negative[k] = std::signbit(d);
        }
    }

    BOXWOOD_BOTH RaySlabs(const Ray<float>& ray, const Aabb<float>& bounds) : RaySlabs(ray) {
        double reach = 0, largest = 0;
        int z = 0; // as Watertight has it: of equal components the last
        for (int k = 0; k < 3; ++k) {
            const double o = static_cast<double>(origin[k]);
            const double low = std::abs(static_cast<double>(bounds.min[k]) - o);
            const double high = std::abs(static_cast<double>(bounds.max[k]) - o);
            reach = reach < low ? low : reach;
            reach = reach < high ? high : reach;
            const double size = std::abs(static_cast<double>(ray.direction[k]));
            z = size >= largest ? k : z;
            largest = largest < size ? size : largest;
        }
        const double t_margin = (0x1p-20 * reach + 0x1p-147) / largest;
        const bool fits = t_margin < max_float;
        margin = fits ? static_cast<float>(t_margin) : 0;
        for (int k = 0; k < 3; ++k) {
            const double size = std::abs(static_cast<double>(ray.direction[k]));
            const bool underflows = 0x1p-150 * (reach + 1) * largest > 0x1p-23 * reach * size;
            if (k != z && size > 0 && (underflows || !fits))
                entry_rdir[k] = exit_rdir[k] = no_number;
        }
    }

  private:
    static constexpr double max_float = std::numeric_limits<float>::max();
    static constexpr float no_number = std::numeric_limits<float>::quiet_NaN();
};

/// Clips the closed ray span [t_min, t_max] (t_min >= 0) by a closed box, per axis k:
///   near, far = negative[k] ? (max, min) : (min, max)
///   a = (near - origin) * entry_rdir;  t0 = a > t0 ? a : t0     starting with t0 = t_min
///   b = (far - origin) * exit_rdir;    t1 = b < t1 ? b : t1     starting with t1 = t_max
/// entry = t0 - margin, exit = t1. A hit if entry <= exit. Never misses: if a real t in [t_min,
/// t_max] puts origin + t d into the box, it is a hit with entry <= fl(t) <= exit. Right for +-0
/// components (0 * inf = NaN is skipped), origins on a face, flat boxes, and the empty box,
/// which is never hit. NaN in a box or in an rdir does not clip.
BOXWOOD_BOTH inline RaySpan clip(const RaySlabs& ray, const Aabb<float>& box, float t_min,
                                 float t_max) {
    float t0 = t_min, t1 = t_max;
    for (int k = 0; k < 3; ++k) {
        const bool negative = ray.negative[k];
        const float near = negative ? box.max[k] : box.min[k];
        const float far = negative ? box.min[k] : box.max[k];
        const float a = (near - ray.origin[k]) * ray.entry_rdir[k];
        const float b = (far - ray.origin[k]) * ray.exit_rdir[k];
        t0 = a > t0 ? a : t0;
        t1 = b < t1 ? b : t1;
    }
    return {t0 - ray.margin, t1};
}

} // namespace boxwood
