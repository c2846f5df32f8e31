#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/aabb.h"
#include "kernels/primitives/ray.h"

#include <concepts>

namespace boxwood {

/// The part [entry, exit] of a ray that may lie in a box; nothing if entry > exit.
struct RaySpan {
    float entry, exit;

    BOXWOOD_BOTH constexpr bool hit() const { return entry <= exit; }
};

/// The part of a ray within t_min <= t <= t_max (t_min >= 0) that lies in a closed box. K is made
/// once per ray. NaN or infinite input: some answer.
template <class K>
concept RayBoxKernel = DescribedKernel<K> && std::constructible_from < K,
        const Ray<float>
& > &&requires(const K& ray, const Aabb<float>& box, float t_min, float t_max) {
    { clip(ray, box, t_min, t_max) } -> std::same_as<RaySpan>;
};

} // namespace boxwood
