#pragma once

#include "trees/layout.h"

namespace boxwood {

/// The canonical tree as it stands: 32-byte nodes in depth-first order, one item per leaf.
class BinaryLayout {
  public:
    static constexpr std::string_view name = "binary";
    static constexpr std::string_view summary =
        "32-byte nodes in depth-first order, one item per leaf; the plain form";

    BinaryLayout(const Tree& tree, const Executor& executor);

    const Tree& tree() const { return tree_; }
    /// Most nodes on a path from the root to a leaf.
    std::size_t depth() const { return depth_; }
    std::size_t bytes() const { return tree_.nodes.bytes() + tree_.order.bytes(); }

  private:
    Tree tree_;
    std::size_t depth_ = 0;
};

} // namespace boxwood
