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

    double group = 256; ///< most items of a mini-tree
    double prune = 1;   ///< largest root that stays, by the mean area of all roots; 0: all opened
    double joined = 16, block = 1, whole = 1; ///< of the mini-trees, as BinnedSahBuilder's

    static constexpr int most_group = 1 << 20;
    static auto settings() {
        return std::array{
            Setting<BonsaiBuilder>{"group", "most items of a mini-tree", &BonsaiBuilder::group, 16,
                                   most_group},
            Setting<BonsaiBuilder>{"prune", "largest root of a mini-tree, by their mean area",
                                   &BonsaiBuilder::prune, 0, 1e6},
            Setting<BonsaiBuilder>{"joined", "most items of a node that is joined bottom-up",
                                   &BonsaiBuilder::joined, 1, BinnedSahBuilder::most_joined},
            Setting<BonsaiBuilder>{"block", "items that cost as much as one", &BonsaiBuilder::block,
                                   1, BinnedSahBuilder::most_block},
            Setting<BonsaiBuilder>{"whole", "most items of a node left as they lie",
                                   &BonsaiBuilder::whole, 1, BinnedSahBuilder::most_whole}};
    }

    Tree build(Boxes boxes, const Executor& executor) const;
};

} // namespace boxwood
