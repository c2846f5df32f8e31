#pragma once

#include "trees/cuda/builds/binary.cuh"
#include "trees/cuda/queries/radix_pairs.cuh"

namespace boxwood::cuda {

/// A binary tree of any depth, with what a traversal needs beside it: the boxes that it was made
/// of, by item, and parents by find_parents.
struct BinaryTree {
    BinaryView view;
    const Box* boxes = nullptr;
    const std::uint32_t* parents = nullptr;

    BOXWOOD_BOTH const Box& leaf(std::uint32_t slot) const { return boxes[view.items[slot]]; }

    /// Of a subtree that is not all.
    __device__ std::uint32_t parent(std::uint32_t at) const {
        return parents[RadixTreeView::is_leaf(at) ? RadixTreeView::slot(at) : view.n + at];
    }
    /// The subtree that follows this one, left before right; nobody after the last.
    __device__ std::uint32_t next(std::uint32_t at) const {
        const std::uint32_t root = *view.root;
        while (at != root) {
            const std::uint32_t above = parent(at);
            if (view.nodes[above].left == at)
                return view.nodes[above].right;
            at = above;
        }
        return nobody;
    }
};

/// As traverse_radix_tree, from the subtree `at` on to the last. What waits is kept on a stack of
/// no more than these; beyond it, and before it, the parents lead on.
constexpr unsigned binary_stack = 32;
template <class Admits, class Visit>
__device__ void traverse_binary_tree(const BinaryTree& tree, std::uint32_t at, const Admits& admits,
                                     const Visit& visit) {
    std::uint32_t stack[binary_stack]; // a ring: the latest ones
    unsigned top = 0, depth = 0;
    while (at != nobody) {
        if (RadixTreeView::is_leaf(at)) {
            const std::uint32_t slot = RadixTreeView::slot(at);
            if (admits(tree.leaf(slot)))
                visit(slot);
        } else if (const BinaryNode& node = tree.view.nodes[at]; admits(node.box)) {
            stack[top++ % binary_stack] = node.right;
            depth += depth < binary_stack;
            at = node.left;
            continue;
        }
        if (depth > 0) {
            --depth;
            at = stack[--top % binary_stack];
        } else {
            at = tree.next(at);
        }
    }
}

/// One leaf of `a`; within one tree it meets the leaves after its own.
template <bool is_self, class Answers>
__device__ void binary_pairs_of(const BinaryTree& a, const BinaryTree& b, std::uint32_t slot,
                                Answers& answers) {
    const Box box = a.leaf(slot);
    traverse_binary_tree(
        b, is_self ? b.next(slot | RadixNode::leaf_bit) : *b.view.root,
        [&](const Box& other) { return overlaps(box, other); },
        [&](std::uint32_t other) {
            answers.add(pair_of<is_self>(a.view.items[slot], b.view.items[other]));
        });
}

/// A thread per leaf of `a`, of those from `first` on to `end`.
template <bool is_self, Pass pass>
__global__ void binary_pairs(BinaryTree a, BinaryTree b, PairsTo to, std::uint32_t first,
                             std::uint32_t end) {
    const std::uint32_t slot = first + blockIdx.x * blockDim.x + threadIdx.x;
    answer_pairs<pass>(to, slot, slot < end,
                       [&](auto& answers) { binary_pairs_of<is_self>(a, b, slot, answers); });
}

template <bool is_self, Pass pass>
void find_binary_pairs(const BinaryTree& a, const BinaryTree& b, const PairsTo& to, Stream stream) {
    if (a.view.n > 0 && b.view.n > 0)
        launch(stream, blocks_for(a.view.n, radix_threads), radix_threads,
               binary_pairs<is_self, pass>, a, b, to, 0u, a.view.n);
}

} // namespace boxwood::cuda
