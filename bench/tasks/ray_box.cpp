/// Whether a ray meets a box.

#include "bench/tasks/detail/kernel_task.h"
#include "bench/truth/judging/verdict_truth.h"
#include "kernels/oracle/oracle.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

bool do_meet(const RayBoxCase& c) {
    return c.hit == Known::unknown ? oracle::ray_box(c.ray, c.box) : c.hit == Known::yes;
}

/// Every case has its own ray, so each call makes what the kernel needs of it.
template <class K> CaseKernel kernel() {
    return {K::info, precision_of<typename RealOf<K, float>::type>(),
            "one case per call, the preparation of its ray included", [](const Cases& cases) {
                return one_by_one(
                    std::get<std::vector<RayBoxCase>>(cases), [](const RayBoxCase& c) {
                        const RaySpan span = clip(K(c.ray), c.box, c.ray.t_min, c.ray.t_max);
                        return Decision{span.hit() ? Answer::yes : Answer::no, 0};
                    });
            }};
}

} // namespace

const Task& ray_box_task() {
    static const KernelTaskOf<Decision, std::vector<RayBoxCase>> task(
        "ray_box", "of each case: whether a ray meets a box",
        all_kernels<RayBoxKernels>([]<class K>(std::type_identity<K>) { return kernel<K>(); }),
        [](const CaseScene& scene) { return make_verdict_truth<RayBoxCase>(scene, do_meet); });
    return task;
}

} // namespace boxwood::bench
