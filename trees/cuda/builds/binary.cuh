#pragma once

#include "trees/cuda/builds/lbvh.cuh"

namespace boxwood::cuda {

struct BinaryNode {
    Box box;
    std::uint32_t left, right; ///< a node, or a slot with RadixNode::leaf_bit
};

/// A binary tree in the device's memory. One slot: no nodes.
struct BinaryView {
    std::uint32_t n = 0;
    std::uint32_t* items = nullptr; ///< slot -> item
    BinaryNode* nodes = nullptr;    ///< n - 1
    std::uint32_t* root = nullptr;  ///< a node, or the only slot with leaf_bit
};

/// parents: 2n - 1, of slots and then of nodes.
template <class Node>
__device__ void set_parents(const Node* nodes, std::uint32_t self, std::uint32_t n,
                            std::uint32_t* parents) {
    const auto set = [&](std::uint32_t child) {
        parents[RadixTreeView::is_leaf(child) ? RadixTreeView::slot(child) : n + child] = self;
    };
    set(nodes[self].left);
    set(nodes[self].right);
}

/// A thread per node: parents, nobody for the root, and met becomes 0.
__global__ void find_parents(BinaryView of, std::uint32_t* parents, std::uint32_t* met) {
    const std::uint32_t node = blockIdx.x * blockDim.x + threadIdx.x;
    if (node + 1 >= of.n)
        return;
    set_parents(of.nodes, node, of.n, parents);
    met[node] = 0;
    if (node == 0)
        parents[of.n + *of.root] = nobody;
}

/// A thread per slot, upwards: the second one to come to a node goes on. met is 0 before and after.
__global__ void refit_binary(BinaryView of, const Box* boxes, const std::uint32_t* parents,
                             std::uint32_t* met) {
    const std::uint32_t slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot >= of.n)
        return;
    Box box = boxes[of.items[slot]];
    std::uint32_t self = slot | RadixNode::leaf_bit;
    for (std::uint32_t at = parents[slot]; at != nobody; self = at, at = parents[of.n + at]) {
        __threadfence(); // before the other one can know of it
        if (atomicAdd(met + at, 1u) == 0)
            return;
        __threadfence();
        met[at] = 0;
        BinaryNode& node = of.nodes[at];
        const std::uint32_t sibling = node.left == self ? node.right : node.left;
        box.extend(RadixTreeView::is_leaf(sibling) ? boxes[of.items[RadixTreeView::slot(sibling)]]
                                                   : from_other(&of.nodes[sibling].box));
        node.box = box;
    }
}

/// New boxes for the items where they are; parents and met by find_parents.
inline void refit_binary_tree(const BinaryView& of, const Box* boxes, const std::uint32_t* parents,
                              std::uint32_t* met, Stream stream) {
    if (of.n > 1)
        launch(stream, blocks_for(of.n, radix_threads), radix_threads, refit_binary, of, boxes,
               parents, met);
}

} // namespace boxwood::cuda
