#include "bench/tasks/kernels/kernel.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

template <class To> Obb<To> converted(const Obb<double>& box) {
    return {static_cast<Vec3<To>>(box.centre),
            {static_cast<Vec3<To>>(box.axis[0]), static_cast<Vec3<To>>(box.axis[1]),
             static_cast<Vec3<To>>(box.axis[2])},
            static_cast<Vec3<To>>(box.half)};
}

template <class K> Rung obb_rung() {
    using Real = typename K::Real;
    struct Input {
        Obb<Real> a, b;
    };
    return {K::info, precision_of<Real>(), called_one_by_one, [](const Cases& cases) {
                std::vector<Input> inputs;
                for (const auto& c : std::get<std::vector<ObbPairCase>>(cases))
                    inputs.push_back({converted<Real>(c.a), converted<Real>(c.b)});
                return one_by_one<&Answers::verdicts>(
                    std::move(inputs), [](const Input& in) { return K::overlap(in.a, in.b); });
            }};
}

template <class K> Rung fit_rung() {
    using Real = typename K::Real;
    struct Input {
        RigidTransform<Real> transform;
        Aabb<Real> box;
    };
    return {
        K::info, precision_of<Real>(), called_one_by_one, [](const Cases& cases) {
            std::vector<Input> inputs;
            for (const FitCase& c : std::get<std::vector<FitCase>>(cases)) {
                Input& in = inputs.emplace_back();
                for (std::size_t row = 0; row < 3; ++row)
                    in.transform.rotation[row] = static_cast<Vec3<Real>>(c.transform.rotation[row]);
                in.transform.translation = static_cast<Vec3<Real>>(c.transform.translation);
                in.box = {static_cast<Vec3<Real>>(c.box.min), static_cast<Vec3<Real>>(c.box.max)};
            }
            return one_by_one<&Answers::boxes>(std::move(inputs), [](const Input& in) {
                const Aabb<Real> box = K::fit(in.transform, in.box);
                return Aabb<double>{static_cast<Vec3<double>>(box.min),
                                    static_cast<Vec3<double>>(box.max)};
            });
        }};
}

} // namespace

std::vector<Rung> obb_rungs() {
    std::vector<Rung> all;
    for_each_kernel<ObbKernels>(
        [&]<class K>(std::type_identity<K>) { all.push_back(obb_rung<K>()); });
    return all;
}

std::vector<Rung> box_fit_rungs() {
    std::vector<Rung> all;
    for_each_kernel<BoxFitKernels>(
        [&]<class K>(std::type_identity<K>) { all.push_back(fit_rung<K>()); });
    return all;
}

} // namespace boxwood::bench
