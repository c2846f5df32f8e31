#pragma once

// A binary tree collapsed to an 8-wide one, by the rule of trees/layouts/detail/collapse.h:
// upwards, what every subtree costs at least as 1 to 8 blocks side by side (a thread per slot);
// downwards, level by level, the cut below each block; then the blocks are numbered by their nodes'
// places in the binary tree, but for the root, and filled. The order within a level is that of a
// race, and nothing depends on it.

#include "trees/cuda/builds/binary.cuh"
#include "trees/cuda/builds/wide8.cuh"
#include "trees/cuda/primitives.h"

#include <bit>

namespace boxwood::cuda {

/// What a subtree costs at least as i + 1 blocks side by side, as floats; once the node has become
/// a block, the refs of its children in the binary tree.
struct alignas(32) CollapseNode {
    std::uint32_t bits[Wide8Node::width];
};

/// Memory, and what the cost of a block is computed with.
struct CollapseRoom {
    static constexpr unsigned max_levels = 32;
    struct Levels {
        double scale;
        float each;
        std::uint32_t begin[max_levels + 1], size[max_levels + 1]; ///< of each level in the queue
    };
    std::uint32_t* parents; ///< 2n - 1: of slots, then of nodes
    std::uint32_t* met;     ///< n - 1: children that are done; then items, if no more than 8
    std::uint32_t* ranks;   ///< n: 1 for what is a block; then blocks before it; last of all blocks
    std::uint32_t* queue;   ///< n - 1: nodes that are blocks
    CollapseNode* nodes;    ///< n - 1
    Levels* levels;         ///< 1
};

/// Node is RadixNode or BinaryNode.
template <class Node> struct BinarySource {
    std::uint32_t n;
    const Node* nodes;
    const std::uint32_t* root;
    const std::uint32_t* items; ///< slot -> item
    const Box* boxes;           ///< of the items

    __device__ static bool is_leaf(std::uint32_t ref) { return RadixTreeView::is_leaf(ref); }
    __device__ Box box(std::uint32_t ref) const {
        return is_leaf(ref) ? boxes[items[RadixTreeView::slot(ref)]] : nodes[ref].box;
    }
};

template <class Node> struct Collapse {
    BinarySource<Node> from;
    CollapseRoom room;

    __device__ float block(std::uint32_t ref) const {
        return static_cast<float>(from.box(ref).half_area() * room.levels->scale) +
               room.levels->each;
    }
    /// As at most i + 1 blocks.
    __device__ float cost(std::uint32_t ref, unsigned i) const {
        return from.is_leaf(ref) ? block(ref) : bits_as<float>(room.nodes[ref].bits[i]);
    }
    /// How many of at most `count` blocks are best left of the node's middle, the fewest of equals.
    __device__ unsigned left_of(std::uint32_t node, unsigned count) const {
        const std::uint32_t left = from.nodes[node].left, right = from.nodes[node].right;
        unsigned best = 1;
        float least = cost(left, 0) + cost(right, count - 2);
        for (unsigned k = 2; k < count; ++k) {
            const float sum = cost(left, k - 1) + cost(right, count - k - 1);
            if (sum < least) {
                least = sum;
                best = k;
            }
        }
        return best;
    }
    /// The children of a node that is a block go to room.nodes[node], in the order of the tree.
    /// Gives how many of them are blocks, too.
    __device__ unsigned cut(std::uint32_t node) const {
        struct Part {
            std::uint32_t ref;
            unsigned blocks; ///< 0: one item each
        };
        Part open[Wide8Node::width];
        unsigned n_open = 0, count = 0, inner = 0;
        const auto split = [&](const Part& part) {
            const unsigned left = part.blocks == 0 ? 0 : left_of(part.ref, part.blocks);
            const Node& at = from.nodes[part.ref];
            open[n_open++] = {at.right, part.blocks - left};
            open[n_open++] = {at.left, left};
        };
        split({node, room.met[node] <= Wide8Node::width ? 0 : Wide8Node::width});
        CollapseNode& to = room.nodes[node];
        while (n_open > 0) {
            Part top = open[--n_open];
            if (!from.is_leaf(top.ref)) {
                while (top.blocks > 1 &&
                       cost(top.ref, top.blocks - 1) == cost(top.ref, top.blocks - 2))
                    --top.blocks;
                if (top.blocks != 1) {
                    split(top);
                    continue;
                }
                ++inner;
            }
            to.bits[count++] = top.ref;
        }
        for (; count < Wide8Node::width; ++count)
            to.bits[count] = nobody;
        room.ranks[node] = 1;
        return inner;
    }
    /// Appends the children of a node that are blocks to the queue.
    __device__ void append(std::uint32_t node, std::uint32_t* to) const {
        for (const std::uint32_t ref : room.nodes[node].bits)
            if (!from.is_leaf(ref))
                *to++ = ref;
    }
    __device__ std::uint32_t number(std::uint32_t node) const {
        const std::uint32_t root = *from.root;
        return node == root ? 0 : room.ranks[node] + (node < root ? 1 : 0);
    }
};

constexpr unsigned collapse_threads = 256;

/// A thread per node: parents, and what else is to begin with.
template <class Node> __global__ void begin_collapse(Collapse<Node> to) {
    const std::uint32_t node = blockIdx.x * blockDim.x + threadIdx.x;
    const std::uint32_t n = to.from.n;
    if (node + 1 >= n)
        return;
    set_parents(to.from.nodes, node, n, to.room.parents);
    to.room.met[node] = to.room.ranks[node] = 0;
    if (node != 0)
        return;
    const std::uint32_t root = *to.from.root;
    to.room.parents[n + root] = nobody;
    to.room.queue[0] = root;
    CollapseRoom::Levels& levels = *to.room.levels;
    const double area = to.from.nodes[root].box.half_area();
    levels.scale = area > 0 ? 1 / area : 0;
    levels.each = area > 0 ? 0x1p-20f : 1;
    for (unsigned i = 0; i <= CollapseRoom::max_levels; ++i)
        levels.begin[i] = levels.size[i] = 0;
    levels.size[0] = 1;
}

/// A thread per slot, upwards: the second one to come to a node goes on.
template <class Node> __global__ void cost_collapse(Collapse<Node> to) {
    constexpr unsigned width = Wide8Node::width;
    const std::uint32_t slot = blockIdx.x * blockDim.x + threadIdx.x, n = to.from.n;
    if (slot >= n)
        return;
    float own[width], other[width], both[width];
    const float leaf = to.block(slot | RadixNode::leaf_bit);
    for (unsigned i = 0; i < width; ++i)
        own[i] = leaf;
    std::uint32_t items = 1, self = slot | RadixNode::leaf_bit, at = to.room.parents[slot];
    for (; at != nobody; self = at, at = to.room.parents[n + at]) {
        __threadfence();
        if (atomicAdd(to.room.met + at, 1u) == 0)
            return;
        __threadfence();
        const Node& node = to.from.nodes[at];
        const std::uint32_t sibling = node.left == self ? node.right : node.left;
        if (to.from.is_leaf(sibling)) {
            const float cost = to.block(sibling);
            for (unsigned i = 0; i < width; ++i)
                other[i] = cost;
            ++items;
        } else {
            const CollapseNode found = from_other(to.room.nodes + sibling);
            for (unsigned i = 0; i < width; ++i)
                other[i] = bits_as<float>(found.bits[i]);
            items += __ldcg(to.room.met + sibling);
        }
        items = items < width + 1 ? items : width + 1;
        for (unsigned i = 1; i < width; ++i) {
            float best = own[0] + other[i - 1];
            for (unsigned k = 1; k < i; ++k) {
                const float sum = own[k] + other[i - 1 - k];
                best = sum < best ? sum : best;
            }
            both[i] = best;
        }
        both[0] = to.block(at) + (items > width ? both[width - 1] : 0);
        CollapseNode result;
        for (unsigned i = 0; i < width; ++i) {
            own[i] = both[i] < both[0] ? both[i] : both[0];
            result.bits[i] = bits_as<std::uint32_t>(own[i]);
        }
        to.room.nodes[at] = result;
        to.room.met[at] = items;
    }
}

/// One level, by any number of blocks.
template <class Node> __global__ void cut_level(Collapse<Node> to, unsigned level) {
    CollapseRoom::Levels& levels = *to.room.levels;
    const std::uint32_t begin = levels.begin[level], size = levels.size[level];
    if (blockIdx.x == 0 && threadIdx.x == 0)
        levels.begin[level + 1] = begin + size;
    for (std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < size;
         i += gridDim.x * blockDim.x) {
        const std::uint32_t node = to.room.queue[begin + i];
        if (const unsigned inner = to.cut(node); inner > 0)
            to.append(node,
                      to.room.queue + begin + size + atomicAdd(&levels.size[level + 1], inner));
    }
}

/// Levels from `level` on by one block: up to another level, or all that are left.
template <class Node> __global__ void cut_levels(Collapse<Node> to, unsigned level, unsigned end) {
    __shared__ std::uint32_t begin, size, next;
    CollapseRoom::Levels& levels = *to.room.levels;
    if (threadIdx.x == 0) {
        begin = levels.begin[level];
        size = levels.size[level];
        next = 0;
    }
    __syncthreads();
    while (size > 0 && level != end) {
        for (std::uint32_t i = threadIdx.x; i < size; i += blockDim.x) {
            const std::uint32_t node = to.room.queue[begin + i];
            if (const unsigned inner = to.cut(node); inner > 0)
                to.append(node, to.room.queue + begin + size + atomicAdd(&next, inner));
        }
        ++level;
        __syncthreads();
        if (threadIdx.x == 0) {
            begin += size;
            size = next;
            next = 0;
        }
        __syncthreads();
    }
    if (threadIdx.x == 0 && end <= CollapseRoom::max_levels) {
        levels.begin[end] = begin;
        levels.size[end] = size;
    }
}

/// A thread per lane of a block, in turns; parents: of the blocks.
template <class Node>
__global__ void fill_wide8(Collapse<Node> from, Wide8Node* to, std::uint32_t* parents,
                           std::uint32_t* n_nodes, Box* bounds) {
    constexpr unsigned width = Wide8Node::width;
    const std::uint32_t n = from.from.n, size = n == 1 ? 1 : from.room.ranks[n - 1];
    std::uint64_t at = std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (at == 0) {
        *n_nodes = size;
        *bounds = from.from.box(*from.from.root);
    }
    for (; at < std::uint64_t{size} * width; at += std::uint64_t{gridDim.x} * blockDim.x) {
        const auto lane = static_cast<unsigned>(at % width);
        std::uint32_t self = 0, ref = lane == 0 ? *from.from.root : nobody;
        if (n > 1) {
            const std::uint32_t node = from.room.queue[at / width];
            self = from.number(node);
            ref = from.room.nodes[node].bits[lane];
        }
        const Box box = ref == nobody ? Box{} : from.from.box(ref);
        if (!from.from.is_leaf(ref)) {
            ref = from.number(ref);
            parents[ref] = self;
        }
        set_lane(to[self], lane, box);
        to[self].ref[lane] = ref;
    }
}

/// to: n - 1 nodes and parents, or one.
template <class Node>
void collapse(const BinarySource<Node>& from, const CollapseRoom& room, const Wide8Tree& to,
              Spare& spare, Stream stream) {
    const Collapse<Node> all{from, room};
    const std::size_t blocks = blocks_for(from.n, collapse_threads);
    if (from.n > 1) {
        launch(stream, blocks, collapse_threads, begin_collapse<Node>, all);
        launch(stream, blocks, collapse_threads, cost_collapse<Node>, all);
        // Most levels are few blocks or not there, and how many there are is known to the device
        // alone: the first three by one block, some by all that may be needed, the rest by one.
        constexpr unsigned first = 3, one_block = 8192;
        const unsigned last =
            from.n < one_block ? first : static_cast<unsigned>(std::bit_width(from.n)) * 2 / 3;
        launch(stream, 1, collapse_threads, cut_levels<Node>, all, 0u, first);
        for (unsigned level = first; level < last; ++level)
            launch(stream, std::min<std::size_t>(blocks, max_wide8_blocks), collapse_threads,
                   cut_level<Node>, all, level);
        launch(stream, 1, collapse_threads, cut_levels<Node>, all, last, ~0u);
        scan(room.ranks, from.n - 1, spare, stream);
    }
    launch(stream, std::min<std::size_t>(blocks, max_wide8_blocks), collapse_threads,
           fill_wide8<Node>, all, to.view.nodes, to.parents, to.n_nodes, to.bounds);
}

} // namespace boxwood::cuda
