#pragma once

#include "kernels/ray_triangle/ray_kernel.h"

#include <cmath>
#include <cstddef>

namespace boxwood {

/// Watertight ray-triangle test, two-sided: no ray slips between triangles that share an edge or
/// vertex bit for bit. For one triangle on its own there is no promise: vertices are sheared in
/// float, so a ray within rounding of an edge or of the triangle's plane may be called either way,
/// and at a shared edge both triangles may be hit. Where the shear is exact, rays in the plane
/// miss. Range: ray_kernel.h; below 2^126 a sheared corner is at most the largest float. Source:
/// Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection".
///
/// Bound, u = 2^-24: a corner at (X, Y, Z) from the origin, Z along the largest component of the
/// direction, moves across the ray by at most 2u |X| + 4u |s Z| + 2^-150 (|Z| + 1) in x, s = d_x /
/// d_z (its roundings: X; s, Z, product; difference; s and the product may underflow), and by u |Z|
/// along it; the same for all triangles that share it. A closed mesh so moved stays closed: nothing
/// leaks from an origin that is not itself left outside. What the rounding of s moves is a shear,
/// which leaves no origin outside, so it is enough to be 6u times the farthest corner and 2^-150
/// from the mesh. What is hit may lie beside the triangle's box, by much if the triangle reaches
/// far behind the hit: RaySlabs and FusedSlabs (ray_box/) make up for it.
struct Watertight {
    static constexpr std::string_view name = "watertight";
    static constexpr KernelInfo info{
        "ray_triangle",
        name,
        "shear to ray space, float edge functions that reject and double ones that decide: no leak "
        "at shared edges (Woop, Benthin, Wald 2013)",
        Promise::never_leaks,
        "corners move across the ray by 2u |X| + 4u |s Z|, u = 2^-24, alike for all who share "
        "them; the signs that follow are exact: closed meshes do not leak (watertight.h)",
        "9 differences, 12 products in float to reject; to hit, 12 products in double"};

    /// Axis z has the largest |direction|; x and y follow it cyclically. shear = direction of x and
    /// y per unit of z, at most 1.
    struct PerRay {
        std::size_t x, y, z;
        float origin_x, origin_y, origin_z, shear_x, shear_y;
        double rdir_z; ///< 1 / direction
    };

    BOXWOOD_BOTH static PerRay prepare(const Ray<float>& ray) {
        // Without branches: those of random rays would be guessed wrong.
        const float o[] = {ray.origin.x, ray.origin.y, ray.origin.z};
        const float d[] = {ray.direction.x, ray.direction.y, ray.direction.z};
        const float ax = std::abs(d[0]), ay = std::abs(d[1]), az = std::abs(d[2]);
        const auto y_largest = static_cast<std::size_t>(ay >= ax);
        const auto z_largest = static_cast<std::size_t>(az >= larger(ax, ay));
        const std::size_t z = larger(y_largest, 2 * z_largest);
        constexpr std::size_t next[] = {1, 2, 0, 1};
        const std::size_t x = next[z], y = next[z + 1];
        const float valid = d[z] - d[z]; // 0, or NaN for an infinite direction, which then misses
        return {x,
                y,
                z,
                o[x],
                o[y],
                o[z],
                d[x] / d[z] + valid,
                d[y] / d[z],
                1 / static_cast<double>(d[z])};
    }

    BOXWOOD_BOTH static bool intersect(const PerRay& r, const Ray<float>& ray,
                                       const Triangle<float>& triangle, float t_max, RayHit& hit) {
        // One branch that goes the same way for all triangles of a ray, and no permutation inside.
        return r.z == 0   ? intersect_along<1, 2, 0>(r, ray, triangle, t_max, hit)
               : r.z == 1 ? intersect_along<2, 0, 1>(r, ray, triangle, t_max, hit)
                          : intersect_along<0, 1, 2>(r, ray, triangle, t_max, hit);
    }

    /// A corner in ray space: z is its depth along the ray.
    struct Sheared {
        float x, y, z;
    };

    struct Decision {
        bool hit;
        float t, u, v;
    };

    /// The second half, for corners whose signs float did not find to differ. Without branches, as
    /// many that come here are behind the origin or the best hit.
    BOXWOOD_BOTH static Decision decide(const PerRay& r, const Ray<float>& ray, const Sheared& a,
                                        const Sheared& b, const Sheared& c, float t_max) {
        // In double the products of floats are exact: these signs are right, zeros included, and
        // the neighbour across an edge computes exactly the negated number.
        const double u = edge(c, b), v = edge(a, c), w = edge(b, a);
        const double low = smaller(smaller(u, v), w), high = larger(larger(u, v), w);
        // No product over- or underflows: the sum is 0 or within 2^-298 .. 2^260. It is 0 only if
        // all three are: in the plane, or no triangle. Then t is NaN, as for NaN input: a miss.
        const double scale = 1 / (u + v + w);
        const double height = u * static_cast<double>(a.z) + v * static_cast<double>(b.z) +
                              w * static_cast<double>(c.z);
        const double t_double = height * scale * r.rdir_z + 0.0; // +0 instead of -0
        const float t = static_cast<float>(t_double);
        const bool inside = (low >= 0) | (high <= 0);
        const bool within =
            (t_double >= static_cast<double>(ray.t_min)) & (t <= t_max) & (t < RayHit::nowhere);
        return {inside && within, t, static_cast<float>(v * scale + 0.0),
                static_cast<float>(w * scale + 0.0)};
    }

  private:
    template <int x, int y, int z>
    BOXWOOD_BOTH static bool intersect_along(const PerRay& r, const Ray<float>& ray,
                                             const Triangle<float>& triangle, float t_max,
                                             RayHit& hit) {
        const auto shear = [&](Vec3<float> p) {
            const float depth = p[z] - r.origin_z;
            return Sheared{p[x] - r.origin_x - r.shear_x * depth,
                           p[y] - r.origin_y - r.shear_y * depth, depth};
        };
        const Sheared a = shear(triangle.a), b = shear(triangle.b), c = shear(triangle.c);
        // Rounding is monotone, so the difference of two rounded products has the right sign or is
        // zero (NaN if both overflow): unequal signs are certain.
        const float u = c.x * b.y - c.y * b.x;
        const float v = a.x * c.y - a.y * c.x;
        const float w = b.x * a.y - b.y * a.x;
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0))
            return false;
        const Decision decision = decide(r, ray, a, b, c, t_max);
        if (!decision.hit)
            return false;
        hit.t = decision.t;
        hit.u = decision.u;
        hit.v = decision.v;
        return true;
    }

    template <class Real> BOXWOOD_BOTH static Real smaller(Real a, Real b) { return b < a ? b : a; }
    template <class Real> BOXWOOD_BOTH static Real larger(Real a, Real b) { return a < b ? b : a; }

    BOXWOOD_BOTH static double edge(const Sheared& p, const Sheared& q) {
        return static_cast<double>(p.x) * static_cast<double>(q.y) -
               static_cast<double>(p.y) * static_cast<double>(q.x);
    }
};

} // namespace boxwood
