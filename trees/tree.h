#pragma once

#include "kernels/primitives/aabb.h"
#include "trees/buffer.h"

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

namespace boxwood {

using Box = Aabb<float>;
using Boxes = std::span<const Box>;

/// A node of a tree of n items.
template <class Real> struct TreeNodeOf {
    Aabb<Real> box;      ///< bounds of all items below
    std::uint32_t first; ///< first slot of the items below
    std::uint32_t count; ///< number of items below; 1 in a leaf
};
using TreeNode = TreeNodeOf<float>;
static_assert(sizeof(TreeNode) == 32 && sizeof(TreeNodeOf<double>) == 56);

/// The canonical binary tree's form: n items give 2n - 1 nodes in depth-first order and leaves of
/// one item each, so the shape needs no pointers: the left child of node i is i + 1, and a subtree
/// of m items fills 2m - 1 nodes and the slots [first, first + m) of `order`. n = 0 gives no nodes.
template <class Real> struct TreeOf {
    Buffer<TreeNodeOf<Real>> nodes;
    Buffer<std::uint32_t> order; ///< slot -> item (index of the input box)

    TreeOf() = default;
    explicit TreeOf(std::size_t n) : nodes(n ? 2 * n - 1 : 0), order(n) {}

    std::size_t size() const { return order.size(); }
    bool empty() const { return order.empty(); }
    bool is_leaf(std::size_t i) const { return nodes[i].count == 1; }
    static std::size_t left(std::size_t i) { return i + 1; }
    std::size_t right(std::size_t i) const { return i + 2 * std::size_t{nodes[i + 1].count}; }
    std::uint32_t item(std::size_t leaf) const { return order[nodes[leaf].first]; }
    const Aabb<Real>& bounds(std::size_t i) const { return nodes[i].box; }
    std::size_t items_below(std::size_t i) const { return nodes[i].count; }
};

/// What every builder makes and every layout starts from.
/// In a split tree, which is for rays and the nearest points of a mesh alone, a triangle may stand
/// in several leaves: their boxes hold parts that together cover it, and n counts the leaves.
struct Tree : TreeOf<float> {
    using TreeOf::TreeOf;
    bool is_split = false;
};

/// Input that no tree can hold. `index` is the item at fault.
class InvalidBox : public std::invalid_argument {
  public:
    InvalidBox(std::size_t index_, const std::string& what)
        : std::invalid_argument("box " + std::to_string(index_) + ": " + what), index(index_) {}
    std::size_t index;
};

/// The most items one tree can hold: 2n - 1 nodes are numbered in 32 bits, the top bit spared.
inline constexpr std::size_t max_items = std::size_t{1} << 30;

/// Throws InvalidBox for the first box with a NaN, an infinity or min > max, and std::length_error
/// for more than max_items boxes.
void require_valid(Boxes boxes);
/// The last of these alone.
void require_at_most_max_items(std::size_t n_boxes);
/// The same for one box, which is said to have this index.
void require_valid(const Box& box, std::size_t index);

} // namespace boxwood
