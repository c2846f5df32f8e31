#pragma once

#include "trees/builder.h"

#include <array>

namespace boxwood {

/// Top-down build by the binned surface-area heuristic: centres fall into bins along each axis, and
/// the cheapest of the planes between bins, counted as items times half area, splits the node.
/// Small nodes are joined from the bottom up, nearest pairs first, which is both quicker and
/// better. Nodes whose centres coincide are halved. O(n log n), depth at most 3 log2(n) + 33.
/// Sources: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies"; for small
/// nodes Walter et al. 2008, "Fast Agglomerative Clustering for Rendering".
struct BinnedSahBuilder {
    static constexpr std::string_view name = "binned_sah";
    static constexpr std::string_view summary =
        "top-down, cheapest of the planes between bins by surface area (Wald 2007)";

    double bins = 32;   ///< most bins per axis; a node of m items uses at most 4 + m / 8
    double joined = 16; ///< nodes of up to this many items are joined from the bottom up; 1: none
    /// Items count in whole blocks of this many, a power of two or else the next lower: what a leaf
    /// costs that is tested so many at a time. Rays like 8 with `joined` 8; more area for boxes.
    double block = 1;
    /// Nodes of up to this many items are neither split nor joined but halved as they lie, which is
    /// quicker: for a layout whose leaves take as many.
    double whole = 1;

    static constexpr int most_bins = 32, most_joined = 16, most_block = 16, most_whole = 16;
    static auto settings() {
        return std::array{
            Setting<BinnedSahBuilder>{"bins", "most bins per axis", &BinnedSahBuilder::bins, 2,
                                      most_bins},
            Setting<BinnedSahBuilder>{"joined", "most items of a node that is joined bottom-up",
                                      &BinnedSahBuilder::joined, 1, most_joined},
            Setting<BinnedSahBuilder>{"block", "items that cost as much as one",
                                      &BinnedSahBuilder::block, 1, most_block},
            Setting<BinnedSahBuilder>{"whole", "most items of a node left as they lie",
                                      &BinnedSahBuilder::whole, 1, most_whole}};
    }

    Tree build(Boxes boxes, const Executor& executor) const;
};

} // namespace boxwood
