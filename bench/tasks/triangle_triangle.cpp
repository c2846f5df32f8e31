/// Do two triangles share a point?

#include "bench/tasks/detail/pair_blocks.h"
#include "bench/tasks/detail/pairs_on_device.h"
#include "bench/truth/judging/verdict_truth.h"
#include "kernels/oracle/oracle.h"
#include "kernels/oracle/registry.h"
#include "kernels/oracle/second_opinion.h"
#include "kernels/registry.h"

#include <array>

namespace boxwood::bench {
namespace {

template <class K> CaseKernel on_processor() {
    if constexpr (TriangleBatchKernel<K>)
        return block_kernel<K, Decision>(
            [](auto blocks, auto verdicts) { K::intersect(blocks, verdicts); });
    else
        return scalar_kernel<K, TwoTriangles<typename K::Real>, TrianglePairCase>(
            [](const auto& in) { return K::intersect(in.a, in.b); });
}

template <class K> CaseKernel kernel() {
    CaseKernel made = on_processor<K>();
    made.make_on_device = touching_on_device(K::name);
    return made;
}

bool do_touch(const TrianglePairCase& c) {
    if (c.touch != Known::unknown)
        return c.touch == Known::yes;
    const std::array a{c.a.a, c.a.b, c.a.c}, b{c.b.a, c.b.b, c.b.c};
    const bool touch = oracle::intersect(c.a, c.b);
    require_agreement(touch == (oracle::second_opinion::squared_distance(a, b) == 0),
                      [&] { return text_of(c); });
    return touch;
}

} // namespace

const Task& triangle_triangle_task() {
    using Kernels =
        Concatenated<TriangleKernels, std::tuple<CertifiedF32>, oracle::RationalTriangleKernels>;
    static const KernelTaskOf<Decision, std::vector<TrianglePairCase>> task(
        "triangle_triangle", "of each case: do two triangles share a point",
        all_kernels<Kernels>([]<class K>(std::type_identity<K>) { return kernel<K>(); }),
        [](const CaseScene& scene) {
            return make_verdict_truth<TrianglePairCase>(scene, do_touch, query_command);
        });
    return task;
}

} // namespace boxwood::bench
