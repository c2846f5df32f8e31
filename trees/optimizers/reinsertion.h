#pragma once

#include "trees/builder.h"

#include <array>

namespace boxwood {

/// Takes the nodes of the largest area from their places and puts each where the tree's area is
/// least: the place is found by branch and bound from the node's surroundings. Places are searched
/// for a batch of nodes at a time over the same tree, on all threads; then the moves are made in
/// order of gain, each measured again first, so that every move pays. Boxes of leaves stay as they
/// are, which serves split trees and fat leaves too. O(n log n): a search that takes too long is
/// cut short. Sources: Bittner, Hapala and Havran 2013, "Fast Insertion-Based Optimization of
/// Bounding Volume Hierarchies"; Meister and Bittner 2018, "Parallel Reinsertion for Bounding
/// Volume Hierarchy Optimization".
struct ReinsertionOptimizer {
    static constexpr std::string_view name = "reinsertion";
    static constexpr std::string_view summary =
        "moves the nodes of the largest area to where they cost least (Meister and Bittner 2018)";

    int passes = 2;   ///< times that all is gone through at most; one without a move is the last
    double share = 1; ///< part of all nodes that a pass searches for, those of the largest area

    static auto settings() {
        using Owner = ReinsertionOptimizer;
        return std::array{
            Setting<Owner>("passes", "times that all is gone through at most", &Owner::passes, 0,
                           100),
            Setting<Owner>("share",
                           "part of all nodes that a pass searches for, largest area first",
                           &Owner::share, 0, 1)};
    }

    /// Keeps the items and the leaf boxes of a valid tree; the sum of the inner areas does not
    /// grow.
    void improve(Tree& tree, const Executor& executor) const;
};

} // namespace boxwood
