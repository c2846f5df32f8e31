#pragma once

#include "bench/tasks/detail/kernel_task.h"
#include "kernels/oracle/rational.h"
#include "kernels/registry.h"

namespace boxwood::bench {

using MotionKernels = Concatenated<ContinuousKernels, std::tuple<oracle::ExactContinuous>>;

/// A task about motions of one kind.
class MotionTask final : public KernelTaskOf<Impact, MotionCases> {
  public:
    MotionTask(MotionKind kind, std::string_view name, std::string_view summary,
               std::vector<CaseKernel> kernels)
        : KernelTaskOf(name, summary, std::move(kernels), make_impact_truth), kind_(kind) {}
    bool fits(const Cases& cases) const override {
        const auto* motions = std::get_if<MotionCases>(&cases);
        return motions && motions->kind == kind_;
    }

  private:
    MotionKind kind_;
};

/// Settings of the kernel have their defaults.
template <class K, class Function>
CaseKernel motion_kernel(const KernelInfo& info, Function function) {
    return {info, precision_of<typename RealOf<K, double>::type>(), called_one_by_one,
            [function](const Cases& cases) {
                std::vector<LinearMotion> motions;
                for (const MotionCase& c : std::get<MotionCases>(cases).motions)
                    motions.push_back(c.motion);
                return one_by_one(std::move(motions), function);
            }};
}

} // namespace boxwood::bench
