#pragma once

#include "kernels/ray_triangle/ray_kernel.h"

#include <cmath>
#include <limits>
#include <type_traits>

namespace boxwood {

/// Möller-Trumbore in Real arithmetic on float input, two-sided, without an absolute epsilon: only
/// a determinant of 0 is parallel. No promise: each triangle rounds on its own, so rays at shared
/// edges and vertices leak. Source: Möller, Trumbore 1997, "Fast, Minimum Storage Ray/Triangle
/// Intersection".
///
/// Bound: with s = origin - a, d the direction, e an edge and u the unit roundoff of Real, the
/// volumes that are compared, s . (d x e) and det, are within 7 roundings of sums of products: 8u
/// |s||d||e| (Real = float: while no product of three leaves 2^-126 .. 2^127). So a hit may lie
/// beside its triangle by 8u |s| / sin(d, e) across the ray. The slack of RaySlabs, 2^-21 of the
/// distance along each axis, covers that in double unless an edge is seen end-on or a face of its
/// box grazed, to within 2^-29. In float it does not: a tree may lose hits that the kernel alone
/// would report, though never true ones.
template <class Real> struct MollerTrumbore {
    static constexpr bool is_float = std::is_same_v<Real, float>;
    static constexpr std::string_view name =
        is_float ? "moller_trumbore_f32" : "moller_trumbore_f64";
    static constexpr KernelInfo info{
        "ray_triangle",
        name,
        is_float ? "two cross products and Cramer's rule, in float (Möller, Trumbore 1997)"
                 : "two cross products and Cramer's rule, in double (Möller, Trumbore 1997)",
        Promise::none,
        "volumes within 8u |origin - a| |direction| |edge|, each triangle on its own: leaks at "
        "shared edges and vertices (derived in moller_trumbore.h)",
        is_float ? "27 products in float" : "27 products in double"};

    /// float converted once; nothing else is shared.
    struct PerRay {
        Vec3<Real> origin, direction;
    };
    BOXWOOD_BOTH static PerRay prepare(const Ray<float>& ray) {
        return {static_cast<Vec3<Real>>(ray.origin), static_cast<Vec3<Real>>(ray.direction)};
    }

    BOXWOOD_BOTH static bool intersect(const PerRay& r, const Ray<float>& ray,
                                       const Triangle<float>& triangle, float t_max, RayHit& hit) {
        const auto a = static_cast<Vec3<Real>>(triangle.a);
        const Vec3<Real> e1 = static_cast<Vec3<Real>>(triangle.b) - a,
                         e2 = static_cast<Vec3<Real>>(triangle.c) - a;
        const Vec3<Real> p = cross(r.direction, e2);
        const Real det = dot(e1, p), size = std::abs(det);
        const Vec3<Real> s = r.origin - a;
        const Vec3<Real> q = cross(s, e1);
        const Real u = std::copysign(Real{1}, det) * dot(s, p);
        const Real v = std::copysign(Real{1}, det) * dot(r.direction, q);
        if (!(u >= 0 && v >= 0 && u + v <= size && size < inf))
            return false;
        // det = 0 makes t infinite or NaN, a miss; + 0 makes +0 of -0.
        const Real t_real = dot(e2, q) / det + 0;
        const float t = static_cast<float>(t_real);
        if (!(t_real >= Real{ray.t_min} && t <= t_max && t < RayHit::nowhere))
            return false;
        hit.t = t;
        hit.u = static_cast<float>(u / size + 0);
        hit.v = static_cast<float>(v / size + 0);
        return true;
    }

  private:
    static constexpr Real inf = std::numeric_limits<Real>::infinity();
};

} // namespace boxwood
