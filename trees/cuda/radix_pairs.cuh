#pragma once

#include "trees/cuda/lbvh.cuh"
#include "trees/cuda/pairs_to.cuh"

namespace boxwood::cuda {

/// How a thread finds its way: by a stack of what is left to see, or by the ropes, without memory.
enum class Walk : std::uint8_t { stack, ropes };

/// Codes of 63 bits and slots of 30 part at most so often on a path.
constexpr unsigned radix_depth = 94;

/// Calls visit(slot) for each leaf that overlaps the box and lies at slot `from` or later.
template <Walk walk, class Visit>
__device__ void walk_radix_tree(const RadixTreeView& tree, const Box& box, std::uint32_t from,
                                const Visit& visit) {
    std::uint32_t stack[walk == Walk::stack ? radix_depth : 1];
    unsigned depth = 0;
    for (std::uint32_t at = *tree.root;;) {
        std::uint32_t last;
        if (RadixTreeView::is_leaf(at)) {
            last = RadixTreeView::slot(at);
            if (last >= from && overlaps(box, tree.leaves[last]))
                visit(last);
        } else {
            const RadixNode& node = tree.nodes[at];
            last = node.last;
            if (last >= from && overlaps(box, node.box)) {
                if constexpr (walk == Walk::stack)
                    stack[depth++] = node.right;
                at = node.left;
                continue;
            }
        }
        if constexpr (walk == Walk::stack) {
            if (depth == 0)
                return;
            at = stack[--depth];
        } else {
            if (last + 1 == tree.n)
                return;
            at = tree.nodes[last].right;
        }
    }
}

/// A thread per leaf of `a`. Within one tree (is_self) it meets the leaves after its own.
template <bool is_self, Pass pass, Walk walk>
__global__ void radix_pairs(RadixTreeView a, RadixTreeView b, PairsTo to) {
    const std::uint32_t slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot >= a.n || (is_self && slot + 1 == a.n && pass != Pass::count))
        return;
    std::uint64_t at = pass == Pass::fill ? to.at[slot] : 0;
    walk_radix_tree<walk>(b, a.leaves[slot], is_self ? slot + 1 : 0, [&](std::uint32_t other) {
        const std::uint64_t place = pass == Pass::capped ? to.take(1) : at;
        if (pass == Pass::fill || (pass == Pass::capped && place < to.room))
            to.pairs[place] = pair_of<is_self>(a.items[slot], b.items[other]);
        ++at;
    });
    if constexpr (pass == Pass::count)
        to.at[slot] = at;
}

template <bool is_self, Pass pass, Walk walk>
void find_radix_pairs(const RadixTreeView& a, const RadixTreeView& b, const PairsTo& to,
                      Stream stream) {
    if (a.n > 0 && b.n > 0)
        launch(stream, blocks_for(a.n, radix_threads), radix_threads,
               radix_pairs<is_self, pass, walk>, a, b, to);
}

} // namespace boxwood::cuda
