#pragma once

#include "trees/cuda/builds/lbvh.cuh"

#include <algorithm>

namespace boxwood::cuda {

/// Eight boxes side by side, 224 bytes: seven sectors of the device's memory.
struct alignas(32) Wide8Node {
    static constexpr unsigned width = 8;

    /// Min x, y, z, then max x, y, z of each child. Those that are not there come last and are
    /// (+inf, -inf): they overlap nothing and no ray hits them.
    float plane[6][width];
    /// A node, or a slot with RadixNode::leaf_bit; not there: nobody, which has that bit.
    std::uint32_t ref[width];
};
static_assert(sizeof(Wide8Node) == 224);

/// An 8-wide tree in the device's memory, collapsed from a binary one by the rule of the CPU's
/// layout wide8. Node 0 is the root, and there is one for one item, too. Nodes may hold items and
/// nodes side by side; a subtree of up to eight items is one node of items, but one item alone
/// stands in its parent.
struct Wide8View {
    std::uint32_t n = 0;                  ///< items; none: no nodes
    Wide8Node* nodes = nullptr;           ///< fewer than n, or 1
    const std::uint32_t* items = nullptr; ///< slot -> item

    BOXWOOD_BOTH static bool is_leaf(std::uint32_t ref) { return (ref & RadixNode::leaf_bit) != 0; }
    BOXWOOD_BOTH static std::uint32_t slot(std::uint32_t ref) { return ref & ~RadixNode::leaf_bit; }
};

/// The view, and what only refit reads; all in the device's memory.
struct Wide8Tree {
    Wide8View view;
    std::uint32_t* parents = nullptr; ///< of the nodes but the root
    std::uint32_t* met = nullptr;     ///< of each node; 0 between calls
    std::uint32_t* n_nodes = nullptr;
    Box* bounds = nullptr; ///< of all items
};

BOXWOOD_BOTH inline void set_lane(Wide8Node& node, unsigned lane, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
        node.plane[axis][lane] = box.min[axis];
        node.plane[3 + axis][lane] = box.max[axis];
    }
}

constexpr unsigned wide8_threads = 256, max_wide8_blocks = 4096;

/// Eight lanes per node, in turns, upwards from the nodes of items alone: those who come last to a
/// node go on.
__global__ void refit_wide8(Wide8Tree to, const Box* boxes) {
    const unsigned lane = threadIdx.x % 8, mask = 0xffu << (threadIdx.x & 24);
    const std::uint64_t n = *to.n_nodes;
    for (std::uint64_t first = (std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x) / 8;
         first < n; first += std::uint64_t{gridDim.x} * blockDim.x / 8) {
        auto self = static_cast<std::uint32_t>(first);
        std::uint32_t ref = to.view.nodes[self].ref[lane];
        if (__any_sync(mask, !Wide8View::is_leaf(ref)))
            continue;
        for (;;) {
            Wide8Node& node = to.view.nodes[self];
            Box box;
            if (!Wide8View::is_leaf(ref)) {
                for (int axis = 0; axis < 3; ++axis) {
                    box.min[axis] = __ldcg(&node.plane[axis][lane]);
                    box.max[axis] = __ldcg(&node.plane[3 + axis][lane]);
                }
            } else if (ref != nobody) {
                box = boxes[to.view.items[Wide8View::slot(ref)]];
                set_lane(node, lane, box);
            }
            for (unsigned step = 4; step > 0; step /= 2) {
                Box other;
                for (int axis = 0; axis < 3; ++axis) {
                    other.min[axis] = __shfl_xor_sync(mask, box.min[axis], step, 8);
                    other.max[axis] = __shfl_xor_sync(mask, box.max[axis], step, 8);
                }
                box.extend(other);
            }
            if (self == 0) {
                if (lane == 0)
                    *to.bounds = box;
                break;
            }
            const std::uint32_t parent = to.parents[self];
            ref = to.view.nodes[parent].ref[lane];
            if (ref == self)
                set_lane(to.view.nodes[parent], lane, box);
            const int inner = __popc(__ballot_sync(mask, !Wide8View::is_leaf(ref)));
            __threadfence(); // before another one can know of it
            __syncwarp(mask);
            bool is_last = false;
            if (lane == 0) {
                is_last = atomicAdd(to.met + parent, 1u) + 1 == static_cast<std::uint32_t>(inner);
                if (is_last)
                    to.met[parent] = 0;
            }
            __threadfence();
            __syncwarp(mask); // which a shuffle is not
            if (!__shfl_sync(mask, is_last, 0, 8))
                break;
            self = parent;
        }
    }
}

/// New boxes for the items where they are.
inline void refit_wide8_tree(const Wide8Tree& to, const Box* boxes, Stream stream) {
    // Most trees have a node for each three to five items.
    launch(stream,
           std::min<std::size_t>(blocks_for(std::size_t{to.view.n} * 2, wide8_threads),
                                 max_wide8_blocks),
           wide8_threads, refit_wide8, to, boxes);
}

} // namespace boxwood::cuda
