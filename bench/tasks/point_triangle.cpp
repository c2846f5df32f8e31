/// The minimum distance of a point and a triangle: a corner of one triangle of a case, and the
/// other.

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

TrueDistance measured(const TrianglePairCase& c) {
    return true_distance(oracle::squared_distance(c.a.a, c.b), {c.a.a}, {c.b.a, c.b.b, c.b.c});
}

} // namespace

const Task& point_triangle_task() {
    using Kernels = Concatenated<PointTriangleKernels, oracle::RationalPointTriangleKernels>;
    static const KernelTaskOf<Distance, std::vector<TrianglePairCase>> task(
        "point_triangle", "of each case: the minimum distance of a point and a triangle",
        distance_kernels<Kernels, Input>(),
        [](const CaseScene& scene) { return make_distance_truth(scene, measured); });
    return task;
}

} // namespace boxwood::bench
