/// How far apart two convex shapes are: 0 where they overlap.

#include "bench/tasks/detail/shape_kernels.h"

namespace boxwood::bench {

const Task& shape_distance_task() {
    static const KernelTaskOf<Distance, std::vector<ShapePairCase>> task(
        "shape_distance", "of each case: how far apart two convex shapes are",
        shape_distance_kernels<false>(), make_shape_distance_truth);
    return task;
}

} // namespace boxwood::bench
