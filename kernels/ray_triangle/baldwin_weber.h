#pragma once

#include "kernels/ray_triangle/ray_kernel.h"

#include <cmath>
#include <limits>

namespace boxwood {

/// Baldwin-Weber: an affine map takes the triangle to (0,0), (1,0), (0,1); the ray is mapped, cut
/// with the plane w = 0, and its (u, v) there compared. The map is made for every test, as a
/// RayKernel stores nothing per triangle: the nine numbers that the method keeps would leave 36
/// operations. No promise. Source: Baldwin, Weber 2016, "Fast Ray-Triangle Intersections by
/// Coordinate Transformation".
///
/// Bound: none that depends on the triangle alone. The map is one of world coordinates, so u and v
/// are within about 8u |p| / h (p the hit, h the triangle's height, u = 2^-24): far from the
/// world's origin small triangles are lost, and hits may lie beside the triangle's box by 8u |p|,
/// which no slack relative to the ray covers. A tree may lose hits that the kernel alone would
/// report, and the division makes ties on edges fall either way, on small integers too.
struct BaldwinWeber {
    static constexpr std::string_view name = "baldwin_weber_f32";
    static constexpr KernelInfo info{
        "ray_triangle",
        name,
        "map to the unit triangle, in float (Baldwin, Weber 2016)",
        Promise::none,
        "weights within about 8u |hit| / |height of the triangle| in world coordinates: leaks, and "
        "worse far from the world's origin (baldwin_weber.h)",
        "9 divisions to make the map, as none is stored; then 36 operations"};

    struct PerRay {};
    static PerRay prepare(const Ray<float>&) { return {}; }

    static bool intersect(const PerRay&, const Ray<float>& ray, const Triangle<float>& triangle,
                          float t_max, RayHit& hit) {
        const Vec3<float> e1 = triangle.b - triangle.a, e2 = triangle.c - triangle.a;
        const Vec3<float> n = cross(e1, e2);
        const float nx = std::abs(n.x), ny = std::abs(n.y), nz = std::abs(n.z);
        return nx > ny && nx > nz ? along<0>(ray, triangle.a, e1, e2, n, t_max, hit)
               : ny > nz          ? along<1>(ray, triangle.a, e1, e2, n, t_max, hit)
                                  : along<2>(ray, triangle.a, e1, e2, n, t_max, hit);
    }

  private:
    /// One row of the map: i and j follow axis k cyclically. The rows of u and v have no k.
    struct Row {
        float i, j, constant;
    };

    /// k: the axis of the largest |normal|, which is divided by.
    template <int k>
    static bool along(const Ray<float>& ray, Vec3<float> a, Vec3<float> e1, Vec3<float> e2,
                      Vec3<float> n, float t_max, RayHit& hit) {
        constexpr int i = k == 2 ? 0 : k + 1, j = i == 2 ? 0 : i + 1;
        const Row u_row{e2[j] / n[k], -e2[i] / n[k], (a[j] * e2[i] - a[i] * e2[j]) / n[k]};
        const Row v_row{-e1[j] / n[k], e1[i] / n[k], (a[i] * e1[j] - a[j] * e1[i]) / n[k]};
        const Row plane{n[i] / n[k], n[j] / n[k], -dot(n, a) / n[k]};

        const Vec3<float> o = ray.origin, d = ray.direction;
        const float height = o[k] + plane.i * o[i] + plane.j * o[j] + plane.constant;
        const float speed = d[k] + plane.i * d[i] + plane.j * d[j];
        const float t = -height / speed + 0.0f; // + 0 makes +0 of -0
        const float at_i = o[i] + t * d[i], at_j = o[j] + t * d[j];
        const float u = u_row.i * at_i + u_row.j * at_j + u_row.constant;
        const float v = v_row.i * at_i + v_row.j * at_j + v_row.constant;
        constexpr float infinity = std::numeric_limits<float>::infinity();
        if (!(u >= 0 && v >= 0 && u + v <= 1 && t >= ray.t_min && t <= t_max && t < infinity &&
              std::abs(speed) < infinity))
            return false;
        hit.t = t;
        hit.u = u;
        hit.v = v;
        return true;
    }
};

} // namespace boxwood
