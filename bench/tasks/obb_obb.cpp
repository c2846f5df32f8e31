/// Whether two boxes in any pose share a point.

#include "bench/tasks/detail/kernel_task.h"
#include "bench/truth/judging/verdict_truth.h"
#include "kernels/oracle/oracle.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

template <class To> Obb<To> converted(const Obb<double>& box) {
    return {static_cast<Vec3<To>>(box.centre),
            {static_cast<Vec3<To>>(box.axis[0]), static_cast<Vec3<To>>(box.axis[1]),
             static_cast<Vec3<To>>(box.axis[2])},
            static_cast<Vec3<To>>(box.half)};
}

template <class Real> struct Input {
    Obb<Real> a, b;
    explicit Input(const ObbPairCase& c) : a(converted<Real>(c.a)), b(converted<Real>(c.b)) {}
};

bool do_touch(const ObbPairCase& c) {
    if (c.touch != Known::unknown)
        return c.touch == Known::yes;
    const auto pose = [](const Obb<double>& box) {
        return std::array{box.centre, box.axis[0], box.axis[1], box.axis[2]};
    };
    return oracle::boxes_touch(pose(c.a), c.a.half, pose(c.b), c.b.half);
}

} // namespace

const Task& obb_obb_task() {
    static const KernelTaskOf<Decision, std::vector<ObbPairCase>> task(
        "obb_obb", "of each case: whether two boxes in any pose share a point",
        all_kernels<ObbKernels>([]<class K>(std::type_identity<K>) {
            return scalar_kernel<K, Input<typename K::Real>, ObbPairCase>(
                [](const auto& in) { return K::overlap(in.a, in.b); });
        }),
        [](const CaseScene& scene) { return make_verdict_truth<ObbPairCase>(scene, do_touch); });
    return task;
}

} // namespace boxwood::bench
