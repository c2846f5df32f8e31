#pragma once

#include "trees/tree.h"

#include <cstddef>
#include <cstdint>

namespace boxwood {

/// What a step costs in the models below, in units of the caller's choice.
struct QualityModel {
    double c_trav = 1;  ///< visiting an inner node
    double c_isect = 1; ///< testing the item of a leaf

    /// Node visits that the end-point overlap may take: it visits the tree once per item, and stops
    /// taking items when these are spent. 0 leaves it out (epo = 0).
    std::uint64_t epo_visits = std::uint64_t{1} << 24;
};

/// How good a tree is, apart from any clock. A(b) is the surface area of a box; where the root has
/// none, A is its extent summed over the axes, and where it has none of that either every ratio
/// is 1.
struct Quality {
    std::uint64_t n_nodes = 0, n_leaves = 0;
    std::uint64_t depth_max = 0; ///< of a leaf, in edges from the root
    double depth_mean = 0;       ///< over the leaves
    double leaf_mean = 0;        ///< items per leaf
    std::uint64_t bytes = 0;     ///< nodes and order

    /// Expected cost of a random line that meets the root: c_trav times the sum of A(node) /
    /// A(root) over the inner nodes, plus c_isect times the same over the leaves. Source: MacDonald
    /// and Booth 1990; in this form Aila, Karras and Laine 2013.
    double sah_cost = 0;

    /// End-point overlap: over all nodes, c_trav (inner) or c_isect (leaf) times the part of all
    /// item surface that lies in the node but belongs to items outside its subtree; faces of item
    /// boxes stand for the surface, and 0 if they have no area. Source: Aila, Karras and Laine
    /// 2013, "On Quality Metrics of Bounding Volume Hierarchies".
    double epo = 0;
    std::uint64_t epo_items = 0; ///< items that `epo` is based on; fewer than all: an estimate

    /// Mean over the inner nodes of A(left and right) / A(node): how likely a line that meets the
    /// node meets what its children share.
    double overlap = 0;
};

/// Measures a well-formed tree (see `validate`) of these boxes; n = 0 gives zeros. Deterministic.
/// In a split tree each part counts as an item. Throws std::invalid_argument if the number of boxes
/// is not that of the items.
Quality quality(const Tree& tree, Boxes boxes, const QualityModel& model = {});

} // namespace boxwood
