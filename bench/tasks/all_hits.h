#pragma once

#include "bench/tasks/answers.h"
#include "kernels/ray_triangle/ray_kernel.h"
#include "trees/queries/sinks.h"

#include <vector>

namespace boxwood::bench {

/// Answers to rays_all: pairs (ray, triangle). On cases also the hits, one to a pair and in the
/// same order.
struct AllHits final : AnswerList<Pair> {
    std::vector<RayHit> hits;
};

} // namespace boxwood::bench
