#pragma once

#include "kernels/triangle_distance/distance_kernel.h"

namespace boxwood {

/// The distance of two triangles between bounds, for all finite doubles, whatever the mode for
/// denormals; 0, and lo = hi = 0, exactly when they touch. hi - lo <= 2^-32 hi + 2^-1073, so that
/// lo > 0 if they do not touch, but for distances of at most 2^-1073; hi may be infinite near and
/// beyond the largest double, and counts as that. Tier 0 is plain, 1 an exact yes, 2 double-double,
/// 3 whole numbers. Derived in gap_bounds.h and greatest_gap.h. Witnesses: distance_kernel.h.
/// Non-finite input: NaN.
struct CertifiedDistance {
    using Real = double;
    static constexpr std::string_view name = "certified";
    static constexpr KernelInfo info{
        "triangle_distance",
        name,
        "plain witnesses and the gap between the planes there; near contact an exact yes or no, "
        "then double-double, at last whole numbers",
        Promise::certified,
        "lo <= distance <= hi, hi - lo <= 2^-32 hi + 2^-1073; derived in detail/gap_bounds.h",
        "f64 and 80 flops; 2 us near contact, 60 us where double-double does not do (3 ms if the "
        "coordinates span all exponents)",
        0x1p-32};

    static Distance distance(const Triangle<double>& a, const Triangle<double>& b);
};

static_assert(TriangleDistanceKernel<CertifiedDistance>);

} // namespace boxwood
