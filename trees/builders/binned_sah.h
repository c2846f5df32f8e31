#pragma once

#include "trees/builder.h"

#include <array>

namespace boxwood {

/// Top-down build by the binned surface-area heuristic: centres fall into bins along each axis, and
/// the cheapest of the planes between bins, counted as items times half area, splits the node.
/// Nodes whose centres coincide are split at the median. O(n log n).
/// Source: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies".
struct BinnedSahBuilder {
    static constexpr std::string_view name = "binned_sah";
    static constexpr std::string_view summary =
        "top-down, cheapest of the planes between bins by surface area (Wald 2007)";

    double bins = 16; ///< most bins per axis; a node of m items uses at most 4 + m / 16

    static constexpr int most_bins = 64;
    static auto settings() {
        return std::array{Setting<BinnedSahBuilder>{"bins", "most bins per axis",
                                                    &BinnedSahBuilder::bins, 2, most_bins}};
    }

    Tree build(Boxes boxes, const Executor& executor) const;
};

} // namespace boxwood
