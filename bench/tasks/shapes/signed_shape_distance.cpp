/// How far apart two convex shapes are or, below 0, how deep one is in the other.

#include "bench/tasks/detail/shape_kernels.h"

namespace boxwood::bench {

const Task& signed_shape_distance_task() {
    static const KernelTaskOf<Distance, std::vector<ShapePairCase>> task(
        "signed_shape_distance", "of each case: how far apart two convex shapes are, or how deep",
        shape_distance_kernels<true>(), make_signed_shape_distance_truth);
    return task;
}

} // namespace boxwood::bench
