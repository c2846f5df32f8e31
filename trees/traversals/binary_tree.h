#pragma once

#include "trees/dynamic/dynamic_tree.h"
#include "trees/layouts/binary.h"

namespace boxwood::detail {

/// What traversals of two children and one item per leaf visit: nodes by number, the root being 0,
/// with bounds, is_leaf, item, left, right and items_below.
template <class Real> const auto& tree_of(const BinaryLayoutOf<Real>& layout) {
    return layout.tree();
}
inline const DynamicTree& tree_of(const DynamicTree& tree) { return tree; }

/// The child of a node, as what waits on a stack.
template <class T> std::uint32_t left_of(const T& tree, std::uint32_t node) {
    return static_cast<std::uint32_t>(tree.left(node));
}
template <class T> std::uint32_t right_of(const T& tree, std::uint32_t node) {
    return static_cast<std::uint32_t>(tree.right(node));
}

} // namespace boxwood::detail
