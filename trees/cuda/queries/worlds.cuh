#pragma once

#include "trees/cuda/builds/codes.cuh"
#include "trees/cuda/queries/radix_pairs.cuh"
#include "trees/cuda/queries/sorted_answers.cuh"

namespace boxwood::cuda {

/// Many worlds of boxes, which do not meet each other, in one tree: that of each world is a subtree
/// of it, as the world stands above the place in the codes.
struct WorldsView {
    std::uint32_t n;            ///< worlds
    const std::uint32_t* first; ///< n + 1: the boxes of world w, and its slots, begin at first[w]
    const Box* boxes;           ///< valid
    std::uint64_t* codes;       ///< of all boxes, to become what make_radix_tree takes;
    std::uint32_t* items;       ///< and these

    static constexpr int code_bits = 30; ///< 10 per axis of the cube around the world's centres
    BOXWOOD_BOTH static std::uint32_t world(std::uint64_t code) {
        return static_cast<std::uint32_t>(code >> code_bits);
    }
};

constexpr unsigned world_threads = 256;

/// A warp, or a block, per world: codes and order of its boxes.
template <unsigned group> __global__ void sort_worlds(WorldsView to) {
    __shared__ Centres centres[world_threads / group];
    const unsigned rank = Group<group>::rank();
    Centres& all = centres[threadIdx.x / group];
    const std::uint64_t world = Group<group>::index();
    if (world >= to.n) // all of the group or none
        return;
    const std::uint32_t first = to.first[world], n = to.first[world + 1] - first;
    if (rank == 0)
        for (int axis = 0; axis < 3; ++axis) {
            all.low[axis] = 0x7fffffff;
            all.high[axis] = -0x7fffffff - 1;
        }
    Group<group>::sync();
    for (std::uint32_t i = rank; i < n; i += group) {
        const Box box = to.boxes[first + i];
        for (int axis = 0; axis < 3; ++axis) {
            const int centre = ordered(.5f * box.min[axis] + .5f * box.max[axis]);
            atomicMin(&all.low[axis], centre);
            atomicMax(&all.high[axis], centre);
        }
    }
    Group<group>::sync();
    Box bounds;
    for (int axis = 0; axis < 3; ++axis) {
        bounds.min[axis] = from_ordered(all.low[axis]);
        bounds.max[axis] = from_ordered(all.high[axis]);
    }
    const CurveGrid grid = curve_grid(bounds, WorldsView::code_bits / 3);
    std::uint64_t* const codes = to.codes + first;
    for (std::uint32_t i = rank; i < n; i += group)
        codes[i] = curve_code<10>(to.boxes[first + i], Curve::hilbert, grid) << 32 | (first + i);
    Group<group>::sync();
    sort_by_group<group>(codes, n, [](std::uint64_t a, std::uint64_t b) { return a < b; });
    for (std::uint32_t i = rank; i < n; i += group) {
        to.items[first + i] = static_cast<std::uint32_t>(codes[i]);
        codes[i] = world << WorldsView::code_bits | codes[i] >> 32;
    }
}

/// Sorts the boxes of each world along a Hilbert curve. Made for worlds of up to some thousands:
/// a warp has each, or a block if they are of some hundreds on average.
inline void order_worlds(const WorldsView& worlds, std::uint32_t n_boxes, Stream stream) {
    if (n_boxes / 256 < worlds.n)
        launch(stream, blocks_for(std::size_t{worlds.n} * 32, world_threads), world_threads,
               sort_worlds<32>, worlds);
    else
        launch(stream, worlds.n, world_threads, sort_worlds<world_threads>, worlds);
}

/// A thread per slot of the tree over all worlds: the pairs with the later slots of its own world,
/// which follow its node's right child by ropes.
template <Pass pass>
__global__ void world_pairs(WorldsView worlds, RadixTreeView tree, PairsTo to) {
    const std::uint32_t slot = blockIdx.x * blockDim.x + threadIdx.x;
    answer_pairs<pass>(to, slot, slot < tree.n, [&](auto& answers) {
        const std::uint32_t end = worlds.first[WorldsView::world(worlds.codes[slot]) + 1];
        const Box box = tree.leaves[slot];
        if (slot + 1 < end)
            traverse_radix_tree<Traversal::ropes>(
                tree, tree.nodes[slot].right, end,
                [&](const Box& other) { return overlaps(box, other); },
                [&](std::uint32_t other) {
                    answers.add(pair_of<true>(tree.items[slot], tree.items[other]));
                });
    });
}

/// The pairs of each world. By count and fill, with at[slot] those of each slot, they are sorted by
/// world: those of world w begin at at[first[w]].
template <Pass pass>
void find_world_pairs(const WorldsView& worlds, const RadixTreeView& tree, const PairsTo& to,
                      Stream stream) {
    launch(stream, blocks_for(tree.n, radix_threads), radix_threads, world_pairs<pass>, worlds,
           tree, to);
}

} // namespace boxwood::cuda
