#pragma once

#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <cstdint>
#include <vector>

namespace boxwood {

/// Every overlapping pair, ascending: the oracle.
inline std::vector<Pair> brute_force(Boxes boxes) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a)
        for (std::uint32_t b = a + 1; b < boxes.size(); ++b)
            if (overlaps(boxes[a], boxes[b]))
                pairs.push_back({a, b});
    return pairs;
}

} // namespace boxwood
