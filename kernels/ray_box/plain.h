#pragma once

#include "kernels/ray_box/ray_box_kernel.h"

#include <algorithm>

namespace boxwood {

/// The slab test of the textbooks, to compare with: one reciprocal per axis, near and far
/// distinguished by min and max, nothing padded. It loses true hits at corners and edges (both ends
/// carry three roundings, relative error gamma_3 = 3u / (1 - 3u) each, u = 2^-24), and where an
/// origin lies on a face that the ray runs along: 0 * inf = NaN.
struct PlainSlabs {
    static constexpr std::string_view name = "plain";
    static constexpr KernelInfo info{
        "ray_box",
        name,
        "slab test with min and max, nothing padded (Kay, Kajiya 1986)",
        Promise::none,
        "entry and exit within gamma_3, unpadded: corner touches are lost; NaN along faces",
        "6 subtractions, 6 products"};

    Vec3<float> origin, rdir;

    explicit PlainSlabs(const Ray<float>& ray)
        : origin(ray.origin), rdir{1 / ray.direction.x, 1 / ray.direction.y, 1 / ray.direction.z} {}
};

inline RaySpan clip(const PlainSlabs& ray, const Aabb<float>& box, float t_min, float t_max) {
    for (int k = 0; k < 3; ++k) {
        const float a = (box.min[k] - ray.origin[k]) * ray.rdir[k];
        const float b = (box.max[k] - ray.origin[k]) * ray.rdir[k];
        t_min = std::max(t_min, std::min(a, b));
        t_max = std::min(t_max, std::max(a, b));
    }
    return {t_min, t_max};
}

} // namespace boxwood
