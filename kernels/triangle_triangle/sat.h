#pragma once

#include "kernels/triangle_triangle/detail/sat_axes.h"
#include "kernels/triangle_triangle/triangle_kernel.h"

#include <algorithm>
#include <cmath>

namespace boxwood {

/// Whether two closed triangles share a point, by the separating-axis theorem: the 2 normals and 9
/// crosses of edges, and for coplanar pairs the 6 edge normals within the planes; degenerate ones
/// as sat_axes.h says. Exact while the products fit 53 bits (integers up to 2^11), else wrong where
/// the two nearly touch. `maybe` for NaN, infinity and overflow.
/// Source: Gottschalk, Lin, Manocha 1996 (the theorem), with the axes that degenerate pairs need.
struct SatF64 {
    using Real = double;
    static constexpr std::string_view name = "sat_f64";
    static constexpr KernelInfo info{"triangle_triangle",
                                     name,
                                     "separating axes, 17 of them (1996), degenerate pairs by more",
                                     Promise::none,
                                     "none: an axis is lost to rounding where its gap is small",
                                     "about 600 flops"};

    static Decision intersect(const Triangle<double>& a, const Triangle<double>& b) {
        const detail::SatPair pair(a, b);
        double size = 0; // infinite or NaN if any projection is
        const bool apart = detail::any_axis(pair, [&](const Vec3<double>& axis) {
            const double a1 = dot(axis, pair.a[1]), a2 = dot(axis, pair.a[2]);
            const double b0 = dot(axis, pair.b[0]), b1 = dot(axis, pair.b[1]),
                         b2 = dot(axis, pair.b[2]);
            size += std::abs(a1) + std::abs(a2) + std::abs(b0) + std::abs(b1) + std::abs(b2);
            return std::max({0.0, a1, a2}) < std::min({b0, b1, b2}) ||
                   std::max({b0, b1, b2}) < std::min({0.0, a1, a2});
        });
        return {!std::isfinite(size) ? Answer::maybe : apart ? Answer::no : Answer::yes, 0};
    }
};

} // namespace boxwood
