#pragma once

#include "trees/queries/allowed_collisions.h"
#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

/// What the demos show of a tree, by the names of its items.
namespace boxwood::bench {

/// The traversal of self_pairs over a small tree, written to be watched.
struct WatchedTraversal {
    std::vector<std::string> lines; ///< one of each box test
    std::size_t pruned = 0;         ///< pairs that were never looked at
    std::vector<Pair> pairs;        ///< sorted

    /// Of more than `max_lines` only the first and the last ones.
    std::string text(std::size_t max_lines = 1000) const;
};

/// Throws std::logic_error if the library finds other pairs.
WatchedTraversal watched_traversal(const Tree& tree, std::span<const std::string> names);

/// "(base, shoulder), (elbow, wrist)", or "none".
std::string pair_names(std::span<const Pair> pairs, std::span<const std::string> names);

/// The pairs of the tree that are worth reporting, sorted.
std::vector<Pair> reported_pairs(const Tree& tree, const AllowedCollisions& allowed);

/// Refits the tree to new boxes and says which nodes changed.
std::string refit_text(Tree& tree, Boxes boxes, std::span<const std::string> names);

} // namespace boxwood::bench
