#pragma once

#include "kernels/ray_triangle/detail/float_products.h"
#include "kernels/ray_triangle/ray_kernel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace boxwood {

/// Exact ray-triangle test, two-sided: whether they meet is always right, for all finite floats, in
/// any floating-point mode that rounds to nearest. A ray in the triangle's plane misses, and a
/// degenerate triangle is never hit. t is within 0.63 ulp of the true one and u, v within 2^-23; as
/// for all kernels it is a miss if t rounds to infinity. As t is rounded, `t_max` is compared with
/// hit.t, so that the nearest of several does not depend on their order; ray.t_min and ray.t_max
/// are compared exactly. What it hits lies in the triangle's box, and the box test loses no true
/// point: any slack will do.
///
/// Tier 0, u = 2^-53: with corners A, B, C seen from the origin, the volumes d.(B x (c - b)) and
/// cyclic have 7 roundings, so each is within 8u P, P = max|d_k| R S, where R and S are the sums of
/// all components of corners and edges. Products of floats do not leave the doubles' range. Where
/// the mode reads denormal floats as 0, an input is off by 2^-126: 2^-70 in R and S covers it.
/// Hits: D = d.n, n = (b - a) x (c - a), is within 16u P and A.n within 8u R S^2. Where their
/// size, or a volume's sign, is not certain by that (t: to 2^-27), tier 1 sums the products of
/// floats themselves in fixed point.
struct ExactRayTriangle {
    static constexpr std::string_view name = "exact";
    static constexpr KernelInfo info{
        "ray_triangle",
        name,
        "signs of volumes in double where their error bound decides, else sums of products of "
        "floats in fixed point",
        Promise::exact,
        "decisions exact; t within 0.63 ulp, u and v within 2^-23 (derived in exact.h)",
        "filter of 27 products in double, then up to 132 products of floats in 1152-bit fixed "
        "point"};

    struct PerRay {
        Vec3<double> origin, direction;
        double t_min, t_max;
        double reach; ///< max|direction_k|; NaN if the ray has no point or is not finite
    };

    static PerRay prepare(const Ray<float>& ray) {
        PerRay r{widen(ray.origin), widen(ray.direction), widen(ray.t_min), widen(ray.t_max), 0};
        r.reach =
            std::max({std::abs(r.direction.x), std::abs(r.direction.y), std::abs(r.direction.z)});
        if (!(is_finite(r.origin) && is_finite(r.direction) && r.t_min <= r.t_max))
            r.reach = std::numeric_limits<double>::quiet_NaN();
        return r;
    }

    static bool intersect(const PerRay& r, const Ray<float>& ray, const Triangle<float>& triangle,
                          float t_max, RayHit& hit) {
        return decide(r, ray, triangle, t_max, hit).answer == Answer::yes;
    }

    /// The same with the tier that decided: 0 the filter, 1 the exact sums.
    static Decision decide(const PerRay& r, const Ray<float>& ray, const Triangle<float>& triangle,
                           float t_max, RayHit& hit) {
        using Vec = Vec3<double>;
        const Vec a(triangle.a), b(triangle.b), c(triangle.c);
        const Vec from_a = a - r.origin, from_b = b - r.origin, from_c = c - r.origin;
        const Vec ab = b - a, bc = c - b, ca = a - c;
        Weights w{dot(r.direction, cross(from_b, bc)), dot(r.direction, cross(from_c, ca)),
                  dot(r.direction, cross(from_a, ab))};
        const double corners = size(from_a) + size(from_b) + size(from_c) + 0x1p-70;
        const double edges = size(ab) + size(bc) + size(ca) + 0x1p-70;
        const double volume = r.reach * corners * edges, error = 0x1p-50 * volume;
        if (!(volume < std::numeric_limits<double>::infinity()))
            return {Answer::no, 0};
        const double low = std::min({w.a, w.b, w.c}), high = std::max({w.a, w.b, w.c});
        if (low < -error && high > error)
            return {Answer::no, 0};

        std::uint8_t tier = 0;
        if (!(low > error || high < -error)) {
            tier = 1;
            if (!inside_exactly(ray, triangle))
                return {Answer::no, tier};
        }
        const Vec n = cross(ca, ab);
        double depth = dot(r.direction, n), height = dot(from_a, n);
        if (!(std::abs(depth) > 0x1p-21 * volume &&
              std::abs(height) > 0x1p-22 * corners * edges * edges)) {
            tier = 1;
            exact_values(ray, triangle, w, depth, height);
        }
        const double t = height / depth;
        if (compare(t, r.t_min, ray.t_min, ray, triangle, depth, tier) < 0 ||
            compare(t, r.t_max, ray.t_max, ray, triangle, depth, tier) > 0)
            return {Answer::no, tier};
        const float rounded = std::min(std::max(static_cast<float>(t + 0.0), ray.t_min), ray.t_max);
        if (!(rounded <= t_max && rounded < std::numeric_limits<float>::infinity()))
            return {Answer::no, tier};
        hit.t = rounded;
        hit.u = static_cast<float>(std::clamp(w.b / depth, 0.0, 1.0) + 0.0);
        hit.v = static_cast<float>(std::clamp(w.c / depth, 0.0, 1.0) + 0.0);
        return {Answer::yes, tier};
    }

  private:
    /// Six volumes, d.(from_b x from_c) and cyclic: the corners' weights times their sum.
    struct Weights {
        double a, b, c;
    };
    static double size(Vec3<double> p) { return std::abs(p.x) + std::abs(p.y) + std::abs(p.z); }

    /// Exact also where the floating-point mode reads denormals as 0.
    static double widen(float x) {
        const auto bits = std::bit_cast<std::int32_t>(x) & 0x7fffffff;
        if (bits >= 0x800000)
            return static_cast<double>(x);
        return std::copysign(static_cast<double>(bits) * 0x1p-149, static_cast<double>(x));
    }
    static Vec3<double> widen(Vec3<float> p) { return {widen(p.x), widen(p.y), widen(p.z)}; }

    /// d.((p - o) x (q - o)) = d.(p x q) - d.(p x o) - d.(o x q).
    static detail::FloatProducts weight(const Ray<float>& ray, Vec3<float> p, Vec3<float> q) {
        detail::FloatProducts sum;
        sum.add_volume(ray.direction, p, q);
        sum.add_volume(ray.direction, p, ray.origin, 1, true);
        sum.add_volume(ray.direction, ray.origin, q, 1, true);
        return sum;
    }

    [[gnu::noinline]] static bool inside_exactly(const Ray<float>& ray, const Triangle<float>& t) {
        const int a = weight(ray, t.b, t.c).sign(), b = weight(ray, t.c, t.a).sign(),
                  c = weight(ray, t.a, t.b).sign();
        // All zero: the ray is in the plane, or the triangle degenerate. So it is if the sum is
        // zero, and then the signs are mixed or all zero.
        return (std::min({a, b, c}) >= 0 || std::max({a, b, c}) <= 0) && (a | b | c) != 0;
    }

    /// depth = d.n times `factor`, taken away or added.
    static void add_depth(detail::FloatProducts& sum, const Ray<float>& ray,
                          const Triangle<float>& t, float factor, bool minus) {
        sum.add_volume(ray.direction, t.a, t.b, factor, minus);
        sum.add_volume(ray.direction, t.b, t.c, factor, minus);
        sum.add_volume(ray.direction, t.c, t.a, factor, minus);
    }
    /// height = from_a.n = from_a.(from_b x from_c)
    static void add_height(detail::FloatProducts& sum, const Ray<float>& ray,
                           const Triangle<float>& t) {
        sum.add_volume(t.a, t.b, t.c);
        sum.add_volume(ray.origin, t.b, t.c, 1, true);
        sum.add_volume(t.a, ray.origin, t.c, 1, true);
        sum.add_volume(t.a, t.b, ray.origin, 1, true);
    }

    [[gnu::noinline]] static void exact_values(const Ray<float>& ray, const Triangle<float>& t,
                                               Weights& w, double& depth, double& height) {
        w = {0, weight(ray, t.c, t.a).value(), weight(ray, t.a, t.b).value()};
        detail::FloatProducts depths, heights;
        add_depth(depths, ray, t, 1, false);
        add_height(heights, ray, t);
        depth = depths.value();
        height = heights.value();
    }

    /// Sign of (true t) - limit, t being within 2^-26 of it; wide is the limit, exactly.
    static int compare(double t, double wide, float limit, const Ray<float>& ray,
                       const Triangle<float>& triangle, double depth, std::uint8_t& tier) {
        if (t * (1 - 0x1p-26) > wide)
            return 1;
        if (t * (1 + 0x1p-26) < wide)
            return -1;
        tier = 1;
        return compare_exactly(ray, triangle, limit) * (depth > 0 ? 1 : -1);
    }
    [[gnu::noinline]] static int compare_exactly(const Ray<float>& ray,
                                                 const Triangle<float>& triangle, float limit) {
        detail::FloatProducts sum;
        add_height(sum, ray, triangle);
        add_depth(sum, ray, triangle, limit, true);
        return sum.sign();
    }
};

} // namespace boxwood
