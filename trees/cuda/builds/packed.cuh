#pragma once

#include "trees/cuda/launch.h"
#include "trees/layouts/packed.h"

namespace boxwood::cuda {

/// A packed layout in the device's memory: the blocks and items of PackedLayout, byte for byte.
struct PackedView {
    static constexpr unsigned width = PackedBlock::width, max_levels = 8;

    PackedBlock* blocks = nullptr;  ///< leaves first
    std::uint32_t* items = nullptr; ///< slot -> item; whole blocks, 0 beyond n
    std::uint32_t n = 0, depth = 0;
    std::uint32_t first[max_levels + 1] = {}; ///< first block of each level

    BOXWOOD_BOTH std::uint32_t leaves() const { return first[1]; }
    BOXWOOD_BOTH std::uint32_t size(unsigned level) const {
        return first[level + 1] - first[level];
    }
    BOXWOOD_BOTH std::uint32_t root() const { return first[depth] - 1; }
};

/// The levels of n items; the memory is the caller's.
inline PackedView packed_levels(std::uint32_t n) {
    PackedView view;
    view.n = n;
    std::uint32_t blocks = 0;
    for (std::uint32_t below = n; n > 0 && (below > 1 || view.depth == 0); ++view.depth) {
        below = (below + view.width - 1) / view.width;
        view.first[view.depth] = blocks;
        blocks += below;
    }
    view.first[view.depth] = blocks;
    return view;
}

__device__ inline Box lane_box(const PackedBlock& block, unsigned lane) {
    return {{block.plane[0][lane], block.plane[1][lane], block.plane[2][lane]},
            {block.plane[3][lane], block.plane[4][lane], block.plane[5][lane]}};
}
__device__ inline void set_lane(PackedBlock& block, unsigned lane, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
        block.plane[axis][lane] = box.min[axis];
        block.plane[3 + axis][lane] = box.max[axis];
    }
}

/// Half a warp's boxes, merged in all of its lanes. All lanes of the warp must come here.
__device__ inline Box half_warp_bounds(Box box) {
    for (unsigned step = 8; step > 0; step /= 2) {
        Box other;
        for (int axis = 0; axis < 3; ++axis) {
            other.min[axis] = __shfl_xor_sync(~0u, box.min[axis], step, 16);
            other.max[axis] = __shfl_xor_sync(~0u, box.max[axis], step, 16);
        }
        box.extend(other);
    }
    return box;
}

constexpr unsigned packed_threads = 256;

/// A thread per slot, whole blocks: the leaves, and their bounds into the lanes of the level above,
/// or into `bounds` if there is none. order: slot -> item; null: the items are where they are.
__global__ void fill_packed_leaves(PackedView to, const Box* boxes, const std::uint32_t* order,
                                   Box* bounds) {
    const std::uint32_t slot = blockIdx.x * blockDim.x + threadIdx.x;
    const std::uint32_t lane = slot % to.width, block = slot / to.width;
    Box box;
    if (slot < to.n) {
        const std::uint32_t item = order ? order[slot] : to.items[slot];
        box = boxes[item];
        if (order)
            to.items[slot] = item;
    } else if (order && block < to.leaves()) {
        to.items[slot] = 0;
    }
    if (block < to.leaves())
        set_lane(to.blocks[block], lane, box);
    const Box all = half_warp_bounds(box);
    if (lane != 0 || block >= to.leaves())
        return;
    if (to.depth == 1)
        *bounds = all;
    else
        set_lane(to.blocks[to.first[1] + block / to.width], block % to.width, all);
}

/// One level, for a kernel: an array that it looks into at a place known late would be copied.
struct PackedLevel {
    std::uint32_t first, size; ///< blocks
    std::uint32_t lanes;       ///< used ones
    std::uint32_t above;       ///< first block of the level above
    bool is_top;
};
inline PackedLevel packed_level(const PackedView& view, unsigned level) {
    return {view.first[level], view.size(level), level == 0 ? view.n : view.size(level - 1),
            view.first[level + 1], level + 1 == view.depth};
}

__device__ inline void hand_up(PackedBlock* blocks, const PackedLevel& level, std::uint32_t block,
                               const Box& all, Box* bounds) {
    if (level.is_top)
        *bounds = all;
    else
        set_lane(blocks[level.above + block / PackedBlock::width], block % PackedBlock::width, all);
}

/// A thread per lane of a level that has its used lanes: empties the others, and hands up the
/// bounds as above.
__global__ void fill_packed_level(PackedBlock* blocks, PackedLevel level, Box* bounds) {
    const std::uint32_t at = blockIdx.x * blockDim.x + threadIdx.x;
    const std::uint32_t lane = at % PackedBlock::width, block = at / PackedBlock::width;
    const bool is_block = block < level.size;
    Box box;
    if (at < level.lanes)
        box = lane_box(blocks[level.first + block], lane);
    else if (is_block)
        set_lane(blocks[level.first + block], lane, box);
    const Box all = half_warp_bounds(box);
    if (lane == 0 && is_block)
        hand_up(blocks, level, block, all, bounds);
}

inline void fill_level(const PackedView& to, unsigned level, Box* bounds, Stream stream) {
    launch(stream, blocks_for(std::size_t{to.size(level)} * to.width, packed_threads),
           packed_threads, fill_packed_level, to.blocks, packed_level(to, level), bounds);
}

/// Makes the layout of valid boxes in this order, or with `order` null refits it to new boxes.
/// to.blocks, to.items and *bounds have room for it.
inline void fill_packed(const PackedView& to, const Box* boxes, const std::uint32_t* order,
                        Box* bounds, Stream stream) {
    if (to.n == 0)
        return;
    launch(stream, blocks_for(std::size_t{to.leaves()} * to.width, packed_threads), packed_threads,
           fill_packed_leaves, to, boxes, order, bounds);
    for (unsigned level = 1; level < to.depth; ++level)
        fill_level(to, level, bounds, stream);
}

} // namespace boxwood::cuda
