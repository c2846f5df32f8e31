/// Whether and when a moving vertex touches a moving triangle.

#include "bench/tasks/detail/motion_kernels.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

/// Settings have their defaults.
template <class K> CaseKernel kernel() {
    return motion_kernel<K>(K::vertex_face_info, [kernel = K{}](const LinearMotion& m) {
        return kernel.vertex_face(m);
    });
}

class VertexFace final : public KernelTaskOf<Impact, MotionCases> {
  public:
    std::string_view name() const override { return "vertex_face"; }
    std::string_view summary() const override {
        return "of each case: whether and when a moving vertex touches a moving triangle";
    }
    bool fits(const Cases& cases) const override {
        return is_motion(cases, MotionKind::vertex_face);
    }

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

const Task& vertex_face_task() {
    static const VertexFace task;
    return task;
}

} // namespace boxwood::bench
