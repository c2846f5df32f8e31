/// The least distance of two triangles.

#include "bench/tasks/detail/pair_blocks.h"
#include "bench/truth/judging/distance_truth.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/registry.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

template <class Real> struct Input {
    Triangle<Real> a, b;
    explicit Input(const TrianglePairCase& c) : a(converted<Real>(c.a)), b(converted<Real>(c.b)) {}
};

template <class K> CaseKernel kernel() {
    if constexpr (TriangleDistanceBatchKernel<K>)
        return block_kernel<K, Distance>(
            [](auto blocks, auto distances) { K::distance(blocks, distances); });
    else
        return scalar_kernel<K, Input<typename K::Real>, TrianglePairCase>(
            [](const auto& in) { return K::distance(in.a, in.b); });
}

TrueDistance measured(const TrianglePairCase& c) {
    return true_distance(oracle::squared_distance(c.a, c.b),
                         {c.a.a, c.a.b, c.a.c, c.b.a, c.b.b, c.b.c});
}

class TriangleDistance final : public KernelTaskOf<Distance, std::vector<TrianglePairCase>> {
  public:
    std::string_view name() const override { return "triangle_distance"; }
    std::string_view summary() const override {
        return "of each case: the least distance of two triangles";
    }

  protected:
    std::vector<CaseKernel> make_kernels() const override {
        return all_kernels<Concatenated<DistanceKernels, oracle::RationalTriangleDistanceKernels>>(
            []<class K>(std::type_identity<K>) { return kernel<K>(); });
    }
    std::unique_ptr<CaseTruth> make_case_truth(const CaseScene& scene) const override {
        return make_distance_truth(scene, measured);
    }
};

} // namespace

const Task& triangle_distance_task() {
    static const TriangleDistance task;
    return task;
}

} // namespace boxwood::bench
