#include "bench/tasks/instruction_sets.h"

#include "kernels/suggest.h"

#include <fmt/format.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace boxwood::bench {
namespace {

/// Highway's targets are bits, the better the lower.
struct InstructionSet {
    std::string_view name;
    std::int64_t target; ///< the least that it needs
};
constexpr std::array sets {
#if HWY_ARCH_X86
    InstructionSet{"baseline", HWY_SSE4}, InstructionSet{"avx2", HWY_AVX2},
        InstructionSet{"avx512", HWY_AVX3},
#else
    InstructionSet{"baseline", HWY_STATIC_TARGET},
#endif
};

const InstructionSet& named(std::string_view name) {
    return entry_named(name, std::span<const InstructionSet>(sets), "instruction set");
}

/// Names of the targets in a mask, best first.
std::vector<std::string> target_names(std::int64_t targets) {
    std::vector<std::string> names;
    for (; targets != 0; targets &= targets - 1)
        names.emplace_back(hwy::TargetName(targets & -targets));
    return names;
}

} // namespace

std::span<const std::string_view> instruction_sets() {
    static const auto names = [] {
        std::array<std::string_view, sets.size()> all;
        std::ranges::transform(sets, all.begin(), &InstructionSet::name);
        return all;
    }();
    return names;
}

std::optional<std::string> missing_instruction_set(std::string_view name) {
    if (name.empty() || (named(name).target & hwy::SupportedTargets()) != 0)
        return std::nullopt;
    return fmt::format("this processor has no {}", name);
}

InstructionSetLimit::InstructionSetLimit(std::string_view name) {
    if (name.empty())
        return;
    // Of AVX-512 the best kind that the processor has.
    hwy::DisableTargets(name == "avx512" ? 0 : named(name).target - 1);
}

InstructionSetLimit::~InstructionSetLimit() { hwy::DisableTargets(0); }

std::vector<std::string> isas_supported() { return target_names(hwy::SupportedTargets()); }

std::string isa_used() { return target_names(hwy::SupportedTargets() & HWY_TARGETS).at(0); }

} // namespace boxwood::bench
