#pragma once

#include "kernels/ray_triangle/ray_kernel.h"

#include <cmath>
#include <limits>

namespace boxwood {

/// Watertight ray-triangle test, two-sided: no ray slips between triangles that share an edge or
/// vertex bit for bit. For one triangle on its own there is no promise: vertices are sheared in
/// float, so a ray within rounding of an edge or of the triangle's plane may be called either way,
/// and at a shared edge both triangles may be hit. Where the shear is exact, rays in the plane
/// miss. Coordinates below 2^126 in size; a hit whose t overflows float is a miss. Source: Woop,
/// Benthin, Wald 2013, "Watertight Ray/Triangle Intersection".
struct Watertight {
    static constexpr std::string_view name = "watertight";
    static constexpr KernelInfo info{"ray_triangle", name,
                                     "shear to ray space, float edge functions that reject and "
                                     "double ones that decide: no leak at shared edges (Woop 2013)",
                                     Promise::none};

    /// Axis z has the largest |direction|; x and y follow it cyclically. shear = direction of x and
    /// y per unit of z, at most 1.
    struct PerRay {
        int z;
        float shear_x, shear_y;
    };

    static PerRay prepare(const Ray<float>& ray) {
        const Vec3<float> d = ray.direction;
        const float ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
        const int z = ax > ay ? (ax > az ? 0 : 2) : (ay > az ? 1 : 2);
        const float valid = d[z] - d[z]; // 0, or NaN for an infinite direction, which then misses
        return {z, d[next(z)] / d[z] + valid, d[next(next(z))] / d[z]};
    }

    static bool intersect(const PerRay& r, const Ray<float>& ray, const Triangle<float>& triangle,
                          float t_max, RayHit& hit) {
        // One branch that goes the same way for all triangles of a ray, and no permutation inside.
        return r.z == 0   ? intersect_along<0>(r, ray, triangle, t_max, hit)
               : r.z == 1 ? intersect_along<1>(r, ray, triangle, t_max, hit)
                          : intersect_along<2>(r, ray, triangle, t_max, hit);
    }

  private:
    static constexpr int next(int axis) { return axis == 2 ? 0 : axis + 1; }

    template <int z>
    static bool intersect_along(const PerRay& r, const Ray<float>& ray,
                                const Triangle<float>& triangle, float t_max, RayHit& hit) {
        const Sheared a = shear<z>(r, triangle.a - ray.origin);
        const Sheared b = shear<z>(r, triangle.b - ray.origin);
        const Sheared c = shear<z>(r, triangle.c - ray.origin);

        // Rounding is monotone, so the difference of two rounded products has the right sign or is
        // zero (NaN if both overflow): unequal signs are certain.
        {
            const float u = c.x * b.y - c.y * b.x;
            const float v = a.x * c.y - a.y * c.x;
            const float w = b.x * a.y - b.y * a.x;
            if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0))
                return false;
        }
        // In double the products of floats are exact: these signs are right, zeros included, and
        // the neighbour across an edge computes exactly the negated number.
        const double u = edge(c, b), v = edge(a, c), w = edge(b, a);
        if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)))
            return false;
        const double sum = u + v + w; // 0 only if all three are: then t is NaN, a miss

        // In double no product over- or underflows: their sizes are 0 or within 2^-450 .. 2^390.
        // Adding zero turns -0 into 0.
        const double height = u * static_cast<double>(a.z) + v * static_cast<double>(b.z) +
                              w * static_cast<double>(c.z);
        const double t_double = height / (sum * static_cast<double>(ray.direction[z]));
        const float t = static_cast<float>(t_double + 0.0);
        if (!(t_double >= static_cast<double>(ray.t_min) && t <= t_max &&
              t < std::numeric_limits<float>::infinity()))
            return false;
        hit.t = t;
        hit.u = static_cast<float>(v / sum + 0.0);
        hit.v = static_cast<float>(w / sum + 0.0);
        return true;
    }

    struct Sheared {
        float x, y, z;
    };

    template <int z> static Sheared shear(const PerRay& r, Vec3<float> p) {
        return {p[next(z)] - r.shear_x * p[z], p[next(next(z))] - r.shear_y * p[z], p[z]};
    }

    static double edge(const Sheared& p, const Sheared& q) {
        return static_cast<double>(p.x) * static_cast<double>(q.y) -
               static_cast<double>(p.y) * static_cast<double>(q.x);
    }
};

} // namespace boxwood
