#pragma once

#include "bench/tasks/contender.h"

#include <optional>
#include <string>
#include <vector>

namespace boxwood::bench {

/// Embree's rays: one at a time, in packets of 8 and 16, in streams, and every hit; made in
/// peers/embree/embree_rays.cpp.
std::vector<ContenderEntry> embree_rays();

/// Why a peer that is compiled for AVX2 and FMA cannot run here, if so.
inline std::optional<std::string> missing_avx2() {
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
        return "is compiled for AVX2 and FMA, which this processor has not";
    return std::nullopt;
}

} // namespace boxwood::bench
