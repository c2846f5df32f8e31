#pragma once

#include "trees/buffer.h"
#include "trees/executor.h"
#include "trees/layouts/layouts.h"
#include "trees/tree.h"

#include <concepts>
#include <span>
#include <string_view>
#include <type_traits>

namespace boxwood {

/// The canonical tree as it stands: nodes in depth-first order, one item per leaf.
template <class Real_> class BinaryLayoutOf {
  public:
    using Real = Real_;
    using TreeType = std::conditional_t<std::is_same_v<Real, float>, Tree, TreeOf<Real>>;

    static constexpr std::string_view name = std::is_same_v<Real, float> ? "binary" : "binary_f64";
    static constexpr std::string_view summary =
        std::is_same_v<Real, float>
            ? "32-byte nodes in depth-first order, one item per leaf; the plain form"
            : "56-byte nodes of doubles in depth-first order; pairs of double boxes are exact";

    BinaryLayoutOf(const Tree& tree, const Executor& executor);

    /// The tree's shape around these exact boxes of its items. Throws as exact_boxes.
    static BinaryLayoutOf of_doubles(const Tree& tree, std::span<const Aabb<double>> boxes,
                                     const Executor& executor) requires std::same_as<Real, double>;

    const TreeType& tree() const { return tree_; }
    bool empty() const { return tree_.empty(); }
    /// Number of items.
    std::size_t size() const { return tree_.size(); }
    /// Those of all items; the tree must not be empty.
    const Aabb<Real>& bounds() const { return tree_.nodes[0].box; }
    /// Most nodes on a path from the root to a leaf.
    std::size_t depth() const { return depth_; }
    std::size_t bytes() const { return tree_.nodes.bytes() + tree_.order.bytes(); }

  private:
    BinaryLayoutOf() = default;
    template <class BoxOf> void make(const Tree& tree, const Executor& executor, const BoxOf& box);

    TreeType tree_;
    std::size_t depth_ = 0;
};

extern template class BinaryLayoutOf<float>;
extern template class BinaryLayoutOf<double>;

} // namespace boxwood
