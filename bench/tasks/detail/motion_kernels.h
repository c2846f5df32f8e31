#pragma once

#include "bench/tasks/detail/kernel_task.h"
#include "kernels/oracle/rational.h"
#include "kernels/registry.h"

namespace boxwood::bench {

using MotionKernels = Concatenated<ContinuousKernels, std::tuple<oracle::ExactContinuous>>;

inline bool is_motion(const Cases& cases, MotionKind kind) {
    const auto* motions = std::get_if<MotionCases>(&cases);
    return motions && motions->kind == kind;
}

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
