/// Do two triangles share a point?

#include "bench/tasks/detail/pair_blocks.h"
#include "bench/truth/judging/verdict_truth.h"
#include "kernels/oracle/oracle.h"
#include "kernels/oracle/registry.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

template <class Real> struct Input {
    Triangle<Real> a, b;
    explicit Input(const TrianglePairCase& c) : a(converted<Real>(c.a)), b(converted<Real>(c.b)) {}
};

template <class K> CaseKernel kernel() {
    if constexpr (TriangleBatchKernel<K>)
        return block_kernel<K, Decision>(
            [](auto blocks, auto verdicts) { K::intersect(blocks, verdicts); });
    else
        return scalar_kernel<K, Input<typename K::Real>, TrianglePairCase>(
            [](const auto& in) { return K::intersect(in.a, in.b); });
}

bool do_touch(const TrianglePairCase& c) {
    return c.touch == Known::unknown ? oracle::intersect(c.a, c.b) : c.touch == Known::yes;
}

class TriangleTriangle final : public KernelTaskOf<Decision, std::vector<TrianglePairCase>> {
  public:
    std::string_view name() const override { return "triangle_triangle"; }
    std::string_view summary() const override {
        return "of each case: do two triangles share a point";
    }

  protected:
    std::vector<CaseKernel> make_kernels() const override {
        return all_kernels<Concatenated<TriangleKernels, oracle::RationalTriangleKernels>>(
            []<class K>(std::type_identity<K>) { return kernel<K>(); });
    }
    std::unique_ptr<CaseTruth> make_case_truth(const CaseScene& scene) const override {
        return make_verdict_truth<TrianglePairCase>(scene, do_touch, query_command);
    }
};

} // namespace

const Task& triangle_triangle_task() {
    static const TriangleTriangle task;
    return task;
}

} // namespace boxwood::bench
