/// The least distance of a point and a triangle: a corner of one triangle of a case, and the other.

#include "bench/tasks/detail/kernel_task.h"
#include "bench/truth/judging/distance_truth.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/registry.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

template <class Real> struct Input {
    Vec3<Real> a;
    Triangle<Real> b;
    explicit Input(const TrianglePairCase& c)
        : a(static_cast<Vec3<Real>>(c.a.a)), b(converted<Real>(c.b)) {}
};

template <class K> CaseKernel kernel() {
    return scalar_kernel<K, Input<typename K::Real>, TrianglePairCase>(
        [](const auto& in) { return K::distance(in.a, in.b); });
}

TrueDistance measured(const TrianglePairCase& c) {
    return true_distance(oracle::squared_distance(c.a.a, c.b), {c.a.a, c.b.a, c.b.b, c.b.c});
}

class PointTriangle final : public KernelTaskOf<Distance, std::vector<TrianglePairCase>> {
  public:
    std::string_view name() const override { return "point_triangle"; }
    std::string_view summary() const override {
        return "of each case: the least distance of a point and a triangle";
    }

  protected:
    std::vector<CaseKernel> make_kernels() const override {
        return all_kernels<
            Concatenated<PointTriangleKernels, oracle::RationalPointTriangleKernels>>(
            []<class K>(std::type_identity<K>) { return kernel<K>(); });
    }
    std::unique_ptr<CaseTruth> make_case_truth(const CaseScene& scene) const override {
        return make_distance_truth(scene, measured);
    }
};

} // namespace

const Task& point_triangle_task() {
    static const PointTriangle task;
    return task;
}

} // namespace boxwood::bench
