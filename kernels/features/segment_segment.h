#pragma once

#include "kernels/detail/rescale.h"
#include "kernels/triangle_distance/distance_kernel.h"

#include <array>
#include <cmath>
#include <type_traits>

namespace boxwood {

/// Squared sizes between which products of four lengths stay within the range of Real.
template <class Real>
inline constexpr Real smallest_squared_size = std::is_same_v<Real, float> ? Real(0x1p-50)
                                                                          : Real(0x1p-400);
template <class Real>
inline constexpr Real largest_squared_size = std::is_same_v<Real, float> ? Real(0x1p50)
                                                                         : Real(0x1p400);

template <class Real> constexpr Real in_unit_range(Real x) {
    return x < 0 ? Real(0) : x < 1 ? x : Real(1);
}
/// x / y, held to [0, 1]; 0 where y is 0 (or below, by rounding).
template <class Real> constexpr Real clamped_ratio(Real x, Real y) {
    return y > 0 ? in_unit_range(x / y) : Real(0);
}

/// A point of each of two sets, and what is from b's to a's.
template <class Real> struct NearestPoints {
    Vec3<Real> a, b, offset;

    Distance distance() const {
        const auto d = static_cast<double>(length(offset));
        return {d, d, d, Vec3<double>(a), Vec3<double>(b), 0};
    }
};

/// The nearest points of two segments. by_cross: the lines' parameter from the cross product of the
/// two, which does not cancel if they are nearly parallel; else from 1 - cos^2 (Ericson 2005,
/// "Real-Time Collision Detection", 5.1.9). Clamped; then the other's nearest to it, clamped; then
/// the first again.
template <bool by_cross, class Real>
[[gnu::always_inline]] inline NearestPoints<Real> nearest_on_segments(const Segment<Real>& a,
                                                                      const Segment<Real>& b) {
    const Vec3<Real> ea = a.b - a.a, eb = b.b - b.a, r = a.a - b.a;
    const Real aa = dot(ea, ea), bb = dot(eb, eb), ab = dot(ea, eb);
    const Real ca = dot(ea, r), fb = dot(eb, r);
    Real first;
    if constexpr (by_cross) {
        const Vec3<Real> n = cross(ea, eb);
        first = clamped_ratio(dot(cross(eb, r), n), dot(n, n));
    } else {
        first = clamped_ratio(ab * fb - ca * bb, aa * bb - ab * ab);
    }
    const Real t = clamped_ratio(ab * first + fb, bb), s = clamped_ratio(ab * t - ca, aa);
    return {a.a + s * ea, b.a + t * eb, (r + s * ea) - t * eb};
}

template <class RealOf, bool by_cross> struct SegmentSegmentDistance {
    using Real = RealOf;

    static Distance distance(const Segment<Real>& a, const Segment<Real>& b) {
        const Vec3<Real> ea = a.b - a.a, eb = b.b - b.a, r = a.a - b.a;
        const Real size = dot(ea, ea) + dot(eb, eb) + dot(r, r);
        if (size > smallest_squared_size<Real> && size < largest_squared_size<Real>) [[likely]]
            return nearest_on_segments<by_cross>(a, b).distance();
        return detail::at_unit_size(std::array{a.a, a.b, b.a, b.b}, a, b,
                                    [](const auto& ua, const auto& ub) {
                                        return nearest_on_segments<by_cross>(ua, ub).distance();
                                    });
    }
};

struct SegmentSegmentF32 : SegmentSegmentDistance<float, false> {
    static constexpr std::string_view name = "ericson_f32";
    static constexpr KernelInfo info{"segment_segment",
                                     name,
                                     "nearest points of the lines, clamped (Ericson 2005), in "
                                     "floats",
                                     Promise::none,
                                     "none: 1 - cos^2 cancels",
                                     "about 70 flops"};
};
struct SegmentSegmentF64 : SegmentSegmentDistance<double, false> {
    static constexpr std::string_view name = "ericson_f64";
    static constexpr KernelInfo info{"segment_segment",
                                     name,
                                     "nearest points of the lines, clamped (Ericson 2005)",
                                     Promise::none,
                                     "none: 1 - cos^2 cancels",
                                     "about 70 flops"};
};
struct SegmentSegmentCross : SegmentSegmentDistance<double, true> {
    static constexpr std::string_view name = "cross_product_f64";
    static constexpr KernelInfo info{
        "segment_segment",
        name,
        "nearest points of the lines by their cross product, clamped",
        Promise::none,
        "relative error about u size / distance (measured, not proven)",
        "about 90 flops"};
};

static_assert(SegmentDistanceKernel<SegmentSegmentF32> &&
              SegmentDistanceKernel<SegmentSegmentF64> &&
              SegmentDistanceKernel<SegmentSegmentCross>);

} // namespace boxwood
