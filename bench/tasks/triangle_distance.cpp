/// The minimum distance of two triangles.

#include "bench/tasks/detail/pair_blocks.h"
#include "bench/tasks/detail/pairs_on_device.h"
#include "bench/truth/judging/distance_truth.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/registry.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

template <class K> CaseKernel on_processor() {
    if constexpr (TriangleDistanceBatchKernel<K>)
        return block_kernel<K, Distance>(
            [](auto blocks, auto distances) { K::distance(blocks, distances); });
    else
        return scalar_kernel<K, TwoTriangles<typename K::Real>, TrianglePairCase>(
            [](const auto& in) { return K::distance(in.a, in.b); });
}

template <class K> CaseKernel kernel() {
    CaseKernel made = on_processor<K>();
    made.make_on_device = distances_on_device(K::name);
    return made;
}

TrueDistance measured(const TrianglePairCase& c) {
    return true_distance(oracle::squared_distance(c.a, c.b), {c.a.a, c.a.b, c.a.c},
                         {c.b.a, c.b.b, c.b.c});
}

} // namespace

const Task& triangle_distance_task() {
    using Kernels = Concatenated<DistanceKernels, std::tuple<CertifiedDistanceF32>,
                                 oracle::RationalTriangleDistanceKernels>;
    static const KernelTaskOf<Distance, std::vector<TrianglePairCase>> task(
        "triangle_distance", "of each case: the minimum distance of two triangles",
        all_kernels<Kernels>([]<class K>(std::type_identity<K>) { return kernel<K>(); }),
        [](const CaseScene& scene) { return make_distance_truth(scene, measured); });
    return task;
}

} // namespace boxwood::bench
