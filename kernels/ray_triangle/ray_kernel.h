#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"

#include <concepts>

namespace boxwood {

/// A ray against one triangle. `prepare` does once per ray what all triangles share. `intersect` is
/// true if they meet at t_min <= t <= t_max, and writes t, u and v then and only then; whose
/// triangle it is (hit.triangle) the caller knows. The argument t_max, at most ray.t_max, is
/// compared with hit.t as written, so that the nearest of several triangles does not depend on
/// their order: hit.t <= t_max always, and the true t may exceed ray.t_max by the rounding of
/// hit.t, but for the exact kernels, which compare that exactly. A hit has finite t, u and v: what
/// is so far that t rounds to infinity is a miss, for every kernel and every t_max (make the
/// direction longer). NaN or infinite input is a miss. Range of the promises: coordinates below
/// max_ray_coordinate, 2^126, any finite direction.
template <class K>
concept RayKernel = DescribedKernel<K> &&
    requires(const Ray<float>& ray, const Triangle<float>& triangle, float t_max,
             const typename K::PerRay& per_ray, RayHit& hit) {
    { K::prepare(ray) } -> std::same_as<typename K::PerRay>;
    { K::intersect(per_ray, ray, triangle, t_max, hit) } -> std::same_as<bool>;
};

} // namespace boxwood
