/// Whether and when a moving vertex touches a moving triangle.

#include "bench/tasks/detail/motion_kernels.h"

namespace boxwood::bench {

const Task& vertex_face_task() {
    static const MotionTask task(
        MotionKind::vertex_face, "vertex_face",
        "of each case: whether and when a moving vertex touches a moving triangle",
        all_kernels<MotionKernels>([]<class K>(std::type_identity<K>) {
            return motion_kernel<K>(K::vertex_face_info, [kernel = K{}](const LinearMotion& m) {
                return kernel.vertex_face(m);
            });
        }));
    return task;
}

} // namespace boxwood::bench
