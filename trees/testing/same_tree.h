#pragma once

#include "trees/tree.h"

#include <algorithm>
#include <cstring>

namespace boxwood {

/// Whether two trees have the same order and, to the bit, the same nodes.
inline bool same_tree(const Tree& a, const Tree& b) {
    return std::ranges::equal(a.order, b.order) && a.nodes.size() == b.nodes.size() &&
           (a.nodes.size() == 0 ||
            std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(TreeNode)) == 0);
}

} // namespace boxwood
