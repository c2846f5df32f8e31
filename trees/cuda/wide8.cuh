#pragma once

#include "trees/cuda/lbvh.cuh"

namespace boxwood::cuda {

/// Eight boxes side by side, 224 bytes: seven sectors of the device's memory.
struct alignas(32) Wide8Node {
    static constexpr unsigned width = 8;

    /// Min x, y, z, then max x, y, z of each child. Those that are not there come last and are
    /// (+inf, -inf): they overlap nothing and no ray hits them.
    float plane[6][width];
    std::uint32_t ref[width]; ///< a node, or a slot with RadixNode::leaf_bit; not there: nobody
};
static_assert(sizeof(Wide8Node) == 224);

/// An 8-wide tree in the device's memory, collapsed from a binary one by the rule of the CPU's
/// layout wide8. Node 0 is the root, and there is one for one item, too. Nodes may hold items and
/// nodes side by side; a subtree of up to eight items is one node of items, but one item alone
/// stands in its parent.
struct Wide8View {
    std::uint32_t n = 0;                  ///< items; none: no nodes
    const Wide8Node* nodes = nullptr;     ///< fewer than n, or 1
    const std::uint32_t* items = nullptr; ///< slot -> item

    BOXWOOD_BOTH static bool is_leaf(std::uint32_t ref) { return (ref & RadixNode::leaf_bit) != 0; }
    BOXWOOD_BOTH static std::uint32_t slot(std::uint32_t ref) { return ref & ~RadixNode::leaf_bit; }
};

} // namespace boxwood::cuda
