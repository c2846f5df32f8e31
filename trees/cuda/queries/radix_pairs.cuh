#pragma once

#include "trees/cuda/builds/lbvh.cuh"
#include "trees/cuda/queries/pairs_to.cuh"

namespace boxwood::cuda {

/// How a thread finds its way: by a stack of what is left to see, or by the ropes, without memory.
enum class Traversal : std::uint8_t { stack, ropes };

/// Codes of 63 bits and slots of 30 part at most so often on a path.
constexpr unsigned radix_depth = 94;

/// Calls visit(slot) for each leaf whose box `admits` takes, as it must take all boxes around such
/// a box, from the subtree `at` on up to slot `end`. Where a subtree ends within them, none reaches
/// beyond `end`.
template <Traversal traversal, class Admits, class Visit>
__device__ void traverse_radix_tree(const RadixTreeView& tree, std::uint32_t at, std::uint32_t end,
                                    const Admits& admits, const Visit& visit) {
    std::uint32_t stack[traversal == Traversal::stack ? radix_depth : 1];
    unsigned depth = 0;
    for (;;) {
        std::uint32_t last;
        if (RadixTreeView::is_leaf(at)) {
            last = RadixTreeView::slot(at);
            if (admits(tree.leaves[last]))
                visit(last);
        } else {
            const RadixNode& node = tree.nodes[at];
            last = node.last;
            if (admits(node.box)) {
                if constexpr (traversal == Traversal::stack)
                    stack[depth++] = node.right;
                at = node.left;
                continue;
            }
        }
        if (traversal == Traversal::stack && depth > 0) {
            at = stack[--depth];
        } else {
            if (last + 1 == end)
                return;
            at = tree.nodes[last].right;
        }
    }
}

/// One leaf of `a`. Within one tree (is_self) it meets the leaves after its own: from the right
/// child of its own node on, by ropes.
template <bool is_self, Traversal traversal, class Answers>
__device__ void radix_pairs_of(const RadixTreeView& a, const RadixTreeView& b, std::uint32_t slot,
                               Answers& answers) {
    const Box box = a.leaves[slot];
    if (!is_self || slot + 1 < a.n)
        traverse_radix_tree<traversal>(
            b, is_self ? b.nodes[slot].right : *b.root, b.n,
            [&](const Box& other) { return overlaps(box, other); },
            [&](std::uint32_t other) {
                answers.add(pair_of<is_self>(a.items[slot], b.items[other]));
            });
}

/// A thread per leaf of `a`, of those from `first` on to `end`.
template <bool is_self, Pass pass, Traversal traversal>
__global__ void radix_pairs(RadixTreeView a, RadixTreeView b, PairsTo to, std::uint32_t first,
                            std::uint32_t end) {
    const std::uint32_t slot = first + blockIdx.x * blockDim.x + threadIdx.x;
    answer_pairs<pass>(to, slot, slot < end, [&](auto& answers) {
        radix_pairs_of<is_self, traversal>(a, b, slot, answers);
    });
}

template <bool is_self, Pass pass, Traversal traversal>
void find_radix_pairs(const RadixTreeView& a, const RadixTreeView& b, const PairsTo& to,
                      Stream stream) {
    if (a.n > 0 && b.n > 0)
        launch(stream, blocks_for(a.n, radix_threads), radix_threads,
               radix_pairs<is_self, pass, traversal>, a, b, to, 0u, a.n);
}

} // namespace boxwood::cuda
