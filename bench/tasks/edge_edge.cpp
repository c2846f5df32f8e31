/// Whether and when two moving edges touch.

#include "bench/tasks/detail/motion_kernels.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

/// Settings have their defaults.
template <class K> CaseKernel kernel() {
    return motion_kernel<K>(K::edge_edge_info,
                            [kernel = K{}](const LinearMotion& m) { return kernel.edge_edge(m); });
}

class EdgeEdge final : public KernelTaskOf<Impact, MotionCases> {
  public:
    std::string_view name() const override { return "edge_edge"; }
    std::string_view summary() const override {
        return "of each case: whether and when two moving edges touch";
    }
    bool fits(const Cases& cases) const override { return is_motion(cases, MotionKind::edge_edge); }

  protected:
    std::vector<CaseKernel> make_kernels() const override {
        return all_kernels<MotionKernels>(
            []<class K>(std::type_identity<K>) { return kernel<K>(); });
    }
    std::unique_ptr<CaseTruth> make_case_truth(const CaseScene& scene) const override {
        return make_impact_truth(scene);
    }
};

} // namespace

const Task& edge_edge_task() {
    static const EdgeEdge task;
    return task;
}

} // namespace boxwood::bench
