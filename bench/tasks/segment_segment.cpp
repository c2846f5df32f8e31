/// The minimum distance of two segments: an edge of each triangle of a case.

#include "bench/tasks/detail/kernel_task.h"
#include "bench/truth/judging/distance_truth.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/registry.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

template <class Real> struct Input {
    Segment<Real> a, b;
    explicit Input(const TrianglePairCase& c)
        : a{static_cast<Vec3<Real>>(c.a.a), static_cast<Vec3<Real>>(c.a.b)},
          b{static_cast<Vec3<Real>>(c.b.b), static_cast<Vec3<Real>>(c.b.a)} {}
};

TrueDistance measured(const TrianglePairCase& c) {
    const Input<double> in(c);
    return true_distance(oracle::squared_distance(in.a, in.b), {in.a.a, in.a.b}, {in.b.a, in.b.b});
}

} // namespace

const Task& segment_segment_task() {
    using Kernels = Concatenated<SegmentDistanceKernels, oracle::RationalSegmentDistanceKernels>;
    static const KernelTaskOf<Distance, std::vector<TrianglePairCase>> task(
        "segment_segment", "of each case: the minimum distance of two edges",
        distance_kernels<Kernels, Input>(),
        [](const CaseScene& scene) { return make_distance_truth(scene, measured); });
    return task;
}

} // namespace boxwood::bench
