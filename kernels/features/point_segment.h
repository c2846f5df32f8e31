#pragma once

#include "kernels/features/segment_segment.h"

namespace boxwood {

/// The point's foot on the line, held to the segment.
template <class Real>
[[gnu::always_inline]] inline NearestPoints<Real> nearest_on_segment(const Vec3<Real>& p,
                                                                     const Segment<Real>& s) {
    const Vec3<Real> e = s.b - s.a, r = p - s.a;
    const Real t = clamped_ratio(dot(r, e), dot(e, e));
    return {p, s.a + t * e, r - t * e};
}

template <class RealOf> struct PointSegmentDistance {
    using Real = RealOf;

    static Distance distance(Vec3<Real> a, const Segment<Real>& b) {
        const Vec3<Real> e = b.b - b.a, r = a - b.a;
        const Real size = dot(e, e) + dot(r, r);
        if (size > smallest_squared_size<Real> && size < largest_squared_size<Real>) [[likely]]
            return nearest_on_segment(a, b).distance();
        return detail::at_unit_size(
            std::array{a, b.a, b.b}, a, b,
            [](const auto& ua, const auto& ub) { return nearest_on_segment(ua, ub).distance(); });
    }
};

struct PointSegmentF32 : PointSegmentDistance<float> {
    static constexpr std::string_view name = "projection_f32";
    static constexpr KernelInfo info{"point_segment",
                                     name,
                                     "foot on the line, clamped, in floats",
                                     Promise::none,
                                     "relative error about u size / distance (measured, not "
                                     "proven)",
                                     "about 30 flops"};
};
struct PointSegmentF64 : PointSegmentDistance<double> {
    static constexpr std::string_view name = "projection_f64";
    static constexpr KernelInfo info{"point_segment",
                                     name,
                                     "foot on the line, clamped",
                                     Promise::none,
                                     "relative error about u size / distance (measured, not "
                                     "proven)",
                                     "about 30 flops"};
};

static_assert(PointSegmentKernel<PointSegmentF32> && PointSegmentKernel<PointSegmentF64>);

} // namespace boxwood
