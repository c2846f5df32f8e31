/// The minimum distance of a point and a segment: a corner of one triangle of a case, an edge of
/// the other.

#include "bench/tasks/detail/kernel_task.h"
#include "bench/truth/judging/distance_truth.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/registry.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

template <class Real> struct Input {
    Vec3<Real> a;
    Segment<Real> b;
    explicit Input(const TrianglePairCase& c)
        : a(static_cast<Vec3<Real>>(c.a.a)), b{static_cast<Vec3<Real>>(c.b.b),
                                               static_cast<Vec3<Real>>(c.b.a)} {}
};

TrueDistance measured(const TrianglePairCase& c) {
    const Input<double> in(c);
    return true_distance(oracle::squared_distance(in.a, in.b), {in.a}, {in.b.a, in.b.b});
}

} // namespace

const Task& point_segment_task() {
    using Kernels = Concatenated<PointSegmentKernels, oracle::RationalPointSegmentKernels>;
    static const KernelTaskOf<Distance, std::vector<TrianglePairCase>> task(
        "point_segment", "of each case: the minimum distance of a point and an edge",
        distance_kernels<Kernels, Input>(),
        [](const CaseScene& scene) { return make_distance_truth(scene, measured); });
    return task;
}

} // namespace boxwood::bench
