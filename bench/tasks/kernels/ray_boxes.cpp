#include "bench/tasks/kernels/kernel.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

/// Every case has its own ray, so each call makes what the kernel needs of it.
template <class K> Rung rung() {
    return {K::info, precision_of<typename RealOf<K, float>::type>(),
            "one case per call, the preparation of its ray included", [](const Cases& cases) {
                return one_by_one<&Answers::verdicts>(
                    std::get<std::vector<RayBoxCase>>(cases), [](const RayBoxCase& c) {
                        const RaySpan span = clip(K(c.ray), c.box, c.ray.t_min, c.ray.t_max);
                        return Decision{span.hit() ? Answer::yes : Answer::no, 0};
                    });
            }};
}

} // namespace

std::vector<Rung> ray_box_rungs() {
    std::vector<Rung> all;
    for_each_kernel<RayBoxKernels>(
        [&]<class K>(std::type_identity<K>) { all.push_back(rung<K>()); });
    return all;
}

} // namespace boxwood::bench
