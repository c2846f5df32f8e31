#include "bench/truth/judging/hits_alone.h"

#include "kernels/registry.h"

#include <algorithm>

namespace boxwood::bench {

std::vector<RayHit> hits_alone(const std::string& kernel, const RayCase& c,
                               const std::vector<Triangle<float>>& triangles) {
    std::vector<RayHit> hits;
    with_kernel<RayKernels>(kernel, [&]<class K>(std::type_identity<K>) {
        const auto per_ray = K::prepare(c.ray);
        for (std::uint32_t k = c.first; k < c.first + c.count; ++k) {
            RayHit hit;
            if (K::intersect(per_ray, c.ray, triangles[k], c.ray.t_max, hit)) {
                hit.triangle = k;
                hits.push_back(hit);
            }
        }
    });
    std::ranges::stable_sort(hits, {}, &RayHit::t);
    return hits;
}

} // namespace boxwood::bench
