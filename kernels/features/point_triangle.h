#pragma once

#include "kernels/features/point_segment.h"

namespace boxwood {

namespace point_triangle {

template <class Real> using Points = NearestPoints<Real>;

template <class Real> Points<Real> nearer(const Points<Real>& p, const Points<Real>& q) {
    return dot(q.offset, q.offset) < dot(p.offset, p.offset) ? q : p;
}
/// The nearest point of the three edges: all of a triangle that is a segment or a point.
template <class Real> Points<Real> on_edges(const Vec3<Real>& p, const Triangle<Real>& t) {
    return nearer(nearer(nearest_on_segment(p, Segment<Real>{t.a, t.b}),
                         nearest_on_segment(p, Segment<Real>{t.a, t.c})),
                  nearest_on_segment(p, Segment<Real>{t.b, t.c}));
}
/// The corner a plus v of the way to b and w of that to c.
template <class Real>
Points<Real> at(const Vec3<Real>& p, const Triangle<Real>& t, Real v, Real w) {
    const Vec3<Real> ab = t.b - t.a, ac = t.c - t.a;
    return {p, t.a + (v * ab + w * ac), ((p - t.a) - v * ab) - w * ac};
}

/// The Voronoi regions of corners, edges and inside by 6 dot products. Source: Ericson 2005,
/// "Real-Time Collision Detection", 5.1.5. The products that decide the region are off by about
/// u / sin^2 of the triangle's angle: where that is more than sin itself, it counts as its edges.
struct Regions {
    template <class Real>
    static Points<Real> nearest(const Vec3<Real>& p, const Triangle<Real>& t) {
        const Vec3<Real> ab = t.b - t.a, ac = t.c - t.a, n = cross(ab, ac);
        constexpr Real sliver = std::is_same_v<Real, float> ? Real(0x1p-16) : Real(0x1p-36);
        if (!(dot(n, n) > sliver * (dot(ab, ab) * dot(ac, ac))))
            return on_edges(p, t);
        const Vec3<Real> ap = p - t.a, bp = p - t.b, cp = p - t.c;
        const Real ab_a = dot(ab, ap), ac_a = dot(ac, ap);
        if (ab_a <= 0 && ac_a <= 0)
            return {p, t.a, ap};
        const Real ab_b = dot(ab, bp), ac_b = dot(ac, bp);
        if (ab_b >= 0 && ac_b <= ab_b)
            return {p, t.b, bp};
        const Real ab_c = dot(ab, cp), ac_c = dot(ac, cp);
        if (ac_c >= 0 && ab_c <= ac_c)
            return {p, t.c, cp};
        const Real c = ab_a * ac_b - ab_b * ac_a;
        if (c <= 0 && ab_a >= 0 && ab_b <= 0)
            return nearest_on_segment(p, Segment<Real>{t.a, t.b});
        const Real b = ab_c * ac_a - ab_a * ac_c;
        if (b <= 0 && ac_a >= 0 && ac_c <= 0)
            return nearest_on_segment(p, Segment<Real>{t.a, t.c});
        const Real a = ab_b * ac_c - ab_c * ac_b;
        if (a <= 0 && ac_b >= ab_b && ab_c >= ac_c)
            return nearest_on_segment(p, Segment<Real>{t.b, t.c});
        const Real sum = a + b + c;
        return at(p, t, b / sum, c / sum);
    }
};

/// The foot in the plane by cross products, if it is inside, else the nearest of the edges. Taken
/// twice, the second time of what is left: the first is off by about u / sin of the angle.
struct Foot {
    template <class Real>
    static Points<Real> nearest(const Vec3<Real>& p, const Triangle<Real>& t) {
        const Points<Real> edge = on_edges(p, t);
        const Vec3<Real> ab = t.b - t.a, ac = t.c - t.a, n = cross(ab, ac);
        const Real nn = dot(n, n);
        Vec3<Real> left = p - t.a;
        Real v = 0, w = 0;
        for (int turn = 0; turn < 2; ++turn) {
            const Real dv = dot(cross(left, ac), n) / nn, dw = dot(cross(ab, left), n) / nn;
            left = (left - dv * ab) - dw * ac;
            v += dv, w += dw;
        }
        if (!(v >= 0 && w >= 0 && v + w <= 1))
            return edge;
        return nearer(edge, {p, t.a + (v * ab + w * ac), left});
    }
};

} // namespace point_triangle

template <class RealOf, class Method> struct PointTriangleDistance {
    using Real = RealOf;

    static Distance distance(Vec3<Real> a, const Triangle<Real>& b) {
        const Vec3<Real> e = b.b - b.a, f = b.c - b.a, r = a - b.a;
        const Real size = dot(e, e) + dot(f, f) + dot(r, r);
        if (size > smallest_squared_size<Real> && size < largest_squared_size<Real>) [[likely]]
            return Method::nearest(a, b).distance();
        return detail::at_unit_size(
            std::array{a, b.a, b.b, b.c}, a, b,
            [](const auto& ua, const auto& ub) { return Method::nearest(ua, ub).distance(); });
    }
};

struct PointTriangleF32 : PointTriangleDistance<float, point_triangle::Regions> {
    static constexpr std::string_view name = "ericson_f32";
    static constexpr KernelInfo info{"point_triangle",
                                     name,
                                     "region by six dot products (Ericson 2005), in floats",
                                     Promise::none,
                                     "none: differences of products cancel in slivers",
                                     "about 100 flops"};
};
struct PointTriangleF64 : PointTriangleDistance<double, point_triangle::Regions> {
    static constexpr std::string_view name = "ericson_f64";
    static constexpr KernelInfo info{"point_triangle",
                                     name,
                                     "region by six dot products (Ericson 2005)",
                                     Promise::none,
                                     "none: differences of products cancel in slivers",
                                     "about 100 flops"};
};
struct PointTriangleCross : PointTriangleDistance<double, point_triangle::Foot> {
    static constexpr std::string_view name = "cross_product_f64";
    static constexpr KernelInfo info{
        "point_triangle",
        name,
        "foot in the plane by cross products if inside, else the nearest edge",
        Promise::none,
        "relative error about u size / distance (measured, not proven)",
        "about 200 flops"};
};

static_assert(PointTriangleKernel<PointTriangleF32> && PointTriangleKernel<PointTriangleF64> &&
              PointTriangleKernel<PointTriangleCross>);

} // namespace boxwood
