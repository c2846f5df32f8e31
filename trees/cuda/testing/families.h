#pragma once

#include "trees/queries/sinks.h"
#include "trees/testing/box_families.h"

#include <algorithm>
#include <vector>

namespace boxwood::cuda {

inline constexpr std::uint64_t fibre_seeds = 8;

/// All of them for few boxes, two for many, and of these one where a sanitizer is slow.
inline std::uint64_t seeds_for(const BoxFamily& family) {
#if defined(__SANITIZE_ADDRESS__)
    constexpr std::uint64_t some = 1;
#else
    constexpr std::uint64_t some = 2;
#endif
    return family.boxes.size() <= 300 ? fibre_seeds : some;
}

/// All families of boxes, and sizes around those of warps, blocks and grids.
inline std::vector<BoxFamily> device_families() {
    std::vector<BoxFamily> all = box_families();
    for (const std::size_t n : {0u, 1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 4097u})
        all.push_back({"random " + std::to_string(n), random_boxes(n, n > 1000 ? .05f : .2f, 5)});
    return all;
}

inline std::vector<Pair> sorted(std::vector<Pair> pairs) {
    std::ranges::sort(pairs);
    return pairs;
}

} // namespace boxwood::cuda
