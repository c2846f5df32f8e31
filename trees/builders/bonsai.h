#pragma once

#include "trees/builder.h"
#include "trees/builders/binned_sah.h"

#include <array>

namespace boxwood {

/// Mini-trees: the items are cut into the cells of a Morton curve that hold at most `group` of
/// them, `binned_sah` makes a tree of each cell on its own, and `sweep_sah` makes the tree above
/// the mini-trees. Before that, mini-trees with large roots are pruned: taken apart into subtrees,
/// which frees the top from the cells' borders where these cost most. Quicker than `binned_sah`,
/// as a cell fits in cache, for about the same cost. O(n log n), depth at most 6 log2(n) + 66.
/// Source: Ganestam et al. 2015, "Bonsai: Rapid Bounding Volume Hierarchy Generation using Mini
/// Trees".
struct BonsaiBuilder {
    static constexpr std::string_view name = "bonsai";
    static constexpr std::string_view summary =
        "SAH mini-trees of neighbours, the large ones pruned, under a SAH top (Ganestam 2015)";

    int group = 256;  ///< items of a mini-tree at most
    double prune = 1; ///< largest root that stays, by the mean area of all roots; 0: all opened
    int agglomerate_below = 16, leaf_size = 1, unsplit_below = 1; ///< as BinnedSahBuilder's

    static constexpr int max_group = 1 << 20;
    static auto settings() {
        using Owner = BonsaiBuilder;
        using Binned = BinnedSahBuilder;
        return std::array{
            Setting<Owner>("group", "items of a mini-tree at most", &Owner::group, 16, max_group),
            Setting<Owner>("prune", "largest root of a mini-tree, by their mean area",
                           &Owner::prune, 0, 1e6),
            Setting<Owner>("agglomerate_below",
                           "items of the largest node that is agglomerated bottom-up",
                           &Owner::agglomerate_below, 1, Binned::max_agglomerate_below),
            Setting<Owner>("leaf_size", "items that cost as much as one", &Owner::leaf_size, 1,
                           Binned::max_leaf_size),
            Setting<Owner>("unsplit_below", "items of the largest node that is left as it lies",
                           &Owner::unsplit_below, 1, Binned::max_unsplit_below)};
    }

    Tree build(Boxes boxes, const Executor& executor) const;
};

} // namespace boxwood
