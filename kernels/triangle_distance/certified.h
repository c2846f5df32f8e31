#pragma once

#include "kernels/triangle_distance/distance_kernel.h"

namespace boxwood {

/// The distance of two triangles between bounds that hold for all finite doubles, whatever the mode
/// for denormals; 0, and lo = hi = 0, exactly when they touch. lo > 0 if they do not, but where no
/// double does as a bound. The bounds are within 2^-32 of each other, relative, down to distances
/// of 1e-20 of the size or so. Derived in certified.cpp. Non-finite input: NaN.
struct CertifiedDistance {
    using Real = double;
    static constexpr std::string_view name = "certified";
    static constexpr KernelInfo info{
        "triangle_distance",
        name,
        "plain witnesses and the gap between the planes there; exact yes or no, then double-double "
        "near contact",
        Promise::certified,
        "lo <= distance <= hi, hi - lo about 2^-32 distance or less; derived in certified.cpp",
        "f64 and 80 flops; microseconds near contact"};

    static Distance distance(const Triangle<double>& a, const Triangle<double>& b);
};

static_assert(TriangleDistanceKernel<CertifiedDistance>);

} // namespace boxwood
