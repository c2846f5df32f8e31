/// The axis-aligned box of a transformed box.

#include "bench/tasks/detail/kernel_task.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

template <class Real> struct Input {
    RigidTransform<Real> transform;
    Aabb<Real> box;
    explicit Input(const FitCase& c)
        : box{static_cast<Vec3<Real>>(c.box.min), static_cast<Vec3<Real>>(c.box.max)} {
        for (std::size_t row = 0; row < 3; ++row)
            transform.rotation[row] = static_cast<Vec3<Real>>(c.transform.rotation[row]);
        transform.translation = static_cast<Vec3<Real>>(c.transform.translation);
    }
};

} // namespace

const Task& box_fit_task() {
    static const KernelTaskOf<Aabb<double>, std::vector<FitCase>> task(
        "box_fit", "of each case: the axis-aligned box of a transformed box",
        all_kernels<BoxFitKernels>([]<class K>(std::type_identity<K>) {
            return scalar_kernel<K, Input<typename K::Real>, FitCase>([](const auto& in) {
                const auto box = K::fit(in.transform, in.box);
                return Aabb<double>{static_cast<Vec3<double>>(box.min),
                                    static_cast<Vec3<double>>(box.max)};
            });
        }),
        make_fit_truth);
    return task;
}

} // namespace boxwood::bench
