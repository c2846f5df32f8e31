#pragma once

#include "trees/cuda/launch.h"
#include "trees/tree.h"

namespace boxwood::cuda {

/// An inner node of a binary radix tree over n slots. Node p parts slots [l, p] from [p + 1, r], so
/// that what follows the slots of a subtree that ends at p is the right child of node p: a rope for
/// nothing.
struct RadixNode {
    Box box;
    std::uint32_t left, right; ///< a node, or a slot with `leaf_bit`
    std::uint32_t last;        ///< r

    static constexpr std::uint32_t leaf_bit = 0x80000000u;
};

/// A binary radix tree in the device's memory: slots in the order of the codes. One slot: no nodes.
struct RadixTreeView {
    std::uint32_t n = 0;
    Box* leaves = nullptr;          ///< slot -> box
    std::uint32_t* items = nullptr; ///< slot -> item
    RadixNode* nodes = nullptr;     ///< n - 1
    std::uint32_t* root = nullptr;  ///< a node, or the only slot with leaf_bit

    BOXWOOD_BOTH static bool is_leaf(std::uint32_t ref) { return (ref & RadixNode::leaf_bit) != 0; }
    BOXWOOD_BOTH static std::uint32_t slot(std::uint32_t ref) { return ref & ~RadixNode::leaf_bit; }
    BOXWOOD_BOTH const Box& box(std::uint32_t ref) const {
        return is_leaf(ref) ? leaves[slot(ref)] : nodes[ref].box;
    }
};

/// How high in the tree slots i - 1 and i part: by the first bit in which their codes differ, below
/// all of these by that of the slots themselves.
__device__ inline std::uint64_t parting(const std::uint64_t* codes, std::uint32_t i) {
    const std::uint64_t bits = codes[i - 1] ^ codes[i];
    return bits != 0 ? bits + (std::uint64_t{1} << 32) : (i - 1) ^ i;
}

constexpr unsigned radix_threads = 256;
constexpr std::uint32_t nobody = 0xffffffff;

/// Another thread wrote it: not from a cache of this one's.
template <class T> __device__ T from_other(const T* at) {
    static_assert(sizeof(T) % 4 == 0);
    std::uint32_t words[sizeof(T) / 4];
    for (unsigned i = 0; i < sizeof(T) / 4; ++i)
        words[i] = __ldcg(reinterpret_cast<const std::uint32_t*>(at) + i);
    T value;
    memcpy(&value, words, sizeof value);
    return value;
}

/// A thread per slot, upwards: of the two that come to a node the second goes on (Apetrei 2014,
/// "Fast and Simple Agglomerative LBVH Construction"). codes ascend; items are in place; met[p] is
/// `nobody` for each node. The same codes and other boxes refit the tree.
__global__ void build_radix_tree(RadixTreeView to, const std::uint64_t* codes, const Box* boxes,
                                 std::uint32_t* met) {
    const std::uint32_t slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot >= to.n)
        return;
    Box box = boxes[to.items[slot]];
    to.leaves[slot] = box;
    std::uint32_t first = slot, last = slot, self = slot | RadixNode::leaf_bit;
    while (first > 0 || last + 1 < to.n) {
        const bool is_left =
            first == 0 || (last + 1 < to.n && parting(codes, last + 1) < parting(codes, first));
        const std::uint32_t parent = is_left ? last : first - 1;
        RadixNode& node = to.nodes[parent];
        (is_left ? node.left : node.right) = self;
        __threadfence(); // before the other one can know of it
        const std::uint32_t other = atomicExch(met + parent, is_left ? first : last);
        if (other == nobody)
            return;
        __threadfence();
        const std::uint32_t sibling = __ldcg(is_left ? &node.right : &node.left);
        box.extend(RadixTreeView::is_leaf(sibling)
                       ? from_other(to.leaves + RadixTreeView::slot(sibling))
                       : from_other(&to.nodes[sibling].box));
        (is_left ? last : first) = other;
        node.box = box;
        node.last = last;
        self = parent;
    }
    *to.root = self;
}

inline void make_radix_tree(const RadixTreeView& to, const std::uint64_t* codes, const Box* boxes,
                            std::uint32_t* met, Stream stream) {
    if (to.n > 1)
        fill_bytes(met, 0xff, (to.n - 1) * sizeof(*met), stream);
    launch(stream, blocks_for(to.n, radix_threads), radix_threads, build_radix_tree, to, codes,
           boxes, met);
}

} // namespace boxwood::cuda
