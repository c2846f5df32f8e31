#pragma once

#include "kernels/ray_triangle/ray_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood {

/// Plücker: the ray's sides of the three edges, each as d . ((q - p) x (q + p)) of corners seen
/// from the origin, so that neighbours compute exactly opposite numbers for the edge they share.
/// Relative zero: sides up to 2^-23 of their sum against the others are still inside. No promise.
/// Sources: Platis, Theoharis 2003, "Fast Ray-Tetrahedron Intersection Using Plücker Coordinates";
/// the relative zero is that of Embree's robust test.
///
/// Bound: a side is within 8u |d||q - p||q + p| (u = 2^-24, sums of products). It may exceed the
/// relative zero, so rays at shared vertices still leak, from far off and at a slant; edges away
/// from their ends do not. A hit may lie beside its triangle by 16u |corner| / sin(d, edge),
/// unbounded for edges seen end-on: a tree may lose hits that the kernel alone would report.
struct Plucker {
    static constexpr std::string_view name = "plucker_f32";
    static constexpr KernelInfo info{
        "ray_triangle",
        name,
        "sides of the edges by Plücker coordinates from the ray's origin, relative zero, in float "
        "(Platis, Theoharis 2003)",
        Promise::none,
        "sides within 8u |direction| |q - p| |q + p|, opposite for the neighbour: leaks at "
        "few vertices and no edges (plucker.h)",
        "39 products in float"};

    struct PerRay {};
    static PerRay prepare(const Ray<float>&) { return {}; }

    static bool intersect(const PerRay&, const Ray<float>& ray, const Triangle<float>& triangle,
                          float t_max, RayHit& hit) {
        const Vec3<float> d = ray.direction;
        const Vec3<float> a = triangle.a - ray.origin, b = triangle.b - ray.origin,
                          c = triangle.c - ray.origin;
        const float u = side(d, b, c), v = side(d, c, a), w = side(d, a, b); // facing a, b, c
        const float sum = u + v + w, zero = 0x1p-23f * std::abs(sum);
        if (!((std::min({u, v, w}) >= -zero || std::max({u, v, w}) <= zero) && sum != 0 &&
              std::abs(sum) < std::numeric_limits<float>::infinity()))
            return false; // a sum of 0: the ray is in the plane, or all of it underflows
        const Vec3<float> n = cross(b - a, c - a);
        const float t = dot(a, n) / dot(d, n) + 0.0f; // + 0 makes +0 of -0
        if (!(t >= ray.t_min && t <= t_max && t < std::numeric_limits<float>::infinity()))
            return false;
        hit.t = t;
        hit.u = std::clamp(v / sum, 0.0f, 1.0f) + 0.0f;
        hit.v = std::clamp(w / sum, 0.0f, 1.0f) + 0.0f;
        return true;
    }

  private:
    /// Twice the side of the ray d through the origin on which the line from p to q passes.
    static float side(Vec3<float> d, Vec3<float> p, Vec3<float> q) {
        return dot(d, cross(q - p, q + p));
    }
};

} // namespace boxwood
