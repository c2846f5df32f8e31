#pragma once

#include "kernels/primitives/triangle.h"
#include "kernels/ray_triangle/ray_kernel.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boxwood {

/// The closest hit of each ray by a kernel on every triangle, without a tree: the oracle.
template <RayKernel K>
std::vector<RayHit> brute_force(const TriangleMesh& mesh, std::span<const Ray<float>> rays) {
    std::vector<RayHit> hits;
    for (const Ray<float>& ray : rays) {
        RayHit best;
        best.t = ray.t_max;
        const auto per_ray = K::prepare(ray);
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            RayHit hit;
            if (K::intersect(per_ray, ray, mesh.triangle(i), best.t, hit) &&
                (hit.t < best.t || !best.hit())) {
                hit.triangle = i;
                best = hit;
            }
        }
        hits.push_back(best.hit() ? best : RayHit{});
    }
    return hits;
}

} // namespace boxwood
