#pragma once

#include "trees/queries/sinks.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace boxwood::detail {

/// Ascending; their numbers are below n. Into buckets by the first number, and each bucket by the
/// second: little time for each where no body has many. Takes a copy of the pairs.
inline void sort_pairs(std::vector<Pair>& pairs, std::size_t n) {
    if (pairs.size() < n / 8 + 64) {
        std::ranges::sort(pairs);
        return;
    }
    std::vector<std::size_t> end(n + 1);
    for (const Pair pair : pairs)
        ++end[pair.a + 1];
    for (std::size_t i = 0; i < n; ++i)
        end[i + 1] += end[i];
    std::vector<Pair> placed(pairs.size());
    for (const Pair pair : pairs) // what was the begin of a bucket becomes its end
        placed[end[pair.a]++] = pair;
    for (std::size_t i = 0, begin = 0; i < n; begin = end[i++])
        std::ranges::sort(std::span(placed).subspan(begin, end[i] - begin));
    pairs = std::move(placed);
}

} // namespace boxwood::detail
