/// Whether and when two moving edges touch.

#include "bench/tasks/detail/motion_kernels.h"

namespace boxwood::bench {

const Task& edge_edge_task() {
    static const MotionTask task(
        MotionKind::edge_edge, "edge_edge", "of each case: whether and when two moving edges touch",
        all_kernels<MotionKernels>([]<class K>(std::type_identity<K>) {
            return motion_kernel<K>(K::edge_edge_info, [kernel = K{}](const LinearMotion& m) {
                return kernel.edge_edge(m);
            });
        }));
    return task;
}

} // namespace boxwood::bench
