#pragma once

#include "trees/builder.h"

#include <array>

namespace boxwood {

/// Top-down build by the binned surface-area heuristic: centres fall into bins along each axis, and
/// the cheapest of the planes between bins, counted as items times half area, splits the node.
/// Small nodes are agglomerated from the bottom up, nearest pairs first, which is both quicker and
/// better. Nodes whose centres coincide are halved. O(n log n), depth at most 3 log2(n) + 33.
/// Sources: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies"; for small
/// nodes Walter et al. 2008, "Fast Agglomerative Clustering for Rendering".
struct BinnedSahBuilder {
    static constexpr std::string_view name = "binned_sah";
    static constexpr std::string_view summary =
        "top-down, cheapest of the planes between bins by surface area (Wald 2007)";

    int bins = 32; ///< at most, per axis; a node of m items uses at most 4 + m / 8
    /// Nodes of at most this many items are agglomerated from the bottom up; 1: none.
    int agglomerate_below = 16;
    /// Items are counted in whole leaves of this many, a power of two or else the next lower: for
    /// layouts that test so many at a time. Rays like 8, with `agglomerate_below` 8; boxes like 1.
    int leaf_size = 1;
    /// Nodes of at most this many items are neither split nor agglomerated but halved as they lie,
    /// which is quicker: for a layout whose leaves take as many.
    int unsplit_below = 1;

    static constexpr int max_bins = 32, max_agglomerate_below = 16, max_leaf_size = 16,
                         max_unsplit_below = 16;
    static auto settings() {
        using Owner = BinnedSahBuilder;
        return std::array{
            Setting<Owner>("bins", "bins per axis at most", &Owner::bins, 2, max_bins),
            Setting<Owner>("agglomerate_below",
                           "items of the largest node that is agglomerated bottom-up",
                           &Owner::agglomerate_below, 1, max_agglomerate_below),
            Setting<Owner>("leaf_size", "items that cost as much as one", &Owner::leaf_size, 1,
                           max_leaf_size),
            Setting<Owner>("unsplit_below", "items of the largest node that is left as it lies",
                           &Owner::unsplit_below, 1, max_unsplit_below)};
    }

    Tree build(Boxes boxes, const Executor& executor) const;
};

} // namespace boxwood
