#pragma once

#include "trees/cuda/builds/packed.cuh"

namespace boxwood::cuda {

/// Items of a packed layout that have new boxes, in the device's memory.
struct MovedItems {
    const std::uint32_t* items; ///< in any order; the same more than once does no harm
    std::uint32_t n;
    const std::uint32_t* slots; ///< item -> slot, of all
    std::uint32_t* touched;     ///< of each block of the layout; 0 between calls
};

/// A thread per slot.
__global__ void find_slots(PackedView of, std::uint32_t* slots) {
    const std::uint32_t slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot < of.n)
        slots[of.items[slot]] = slot;
}

/// A thread per moved item.
__global__ void move_packed_items(PackedBlock* blocks, const Box* boxes, MovedItems moved) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= moved.n)
        return;
    const std::uint32_t item = moved.items[i], slot = moved.slots[item];
    set_lane(blocks[slot / PackedBlock::width], slot % PackedBlock::width, boxes[item]);
}

/// Half a warp per moved item: the first to come to its block of a level hands up the bounds.
__global__ void refit_touched(PackedBlock* blocks, PackedLevel level, unsigned shift,
                              MovedItems moved, Box* bounds) {
    const std::uint64_t at = std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x;
    const auto lane = static_cast<unsigned>(at % PackedBlock::width);
    const std::uint64_t i = at / PackedBlock::width;
    std::uint32_t block = 0;
    bool is_own = false;
    if (i < moved.n) {
        block = moved.slots[moved.items[i]] >> shift;
        is_own = lane == 0 && atomicExch(moved.touched + level.first + block, 1u) == 0;
    }
    is_own = __shfl_sync(~0u, is_own, 0, 16);
    const Box all = half_warp_bounds(is_own ? lane_box(blocks[level.first + block], lane) : Box{});
    if (is_own && lane == 0)
        hand_up(blocks, level, block, all, bounds);
}

/// A thread per moved item: touched is 0 again. levels: those that refit_touched went through.
__global__ void forget_touched(PackedView of, unsigned levels, MovedItems moved) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= moved.n)
        return;
    std::uint32_t block = moved.slots[moved.items[i]];
    for (unsigned level = 0; level < of.max_levels; ++level)
        if (level < levels)
            moved.touched[of.first[level] + (block >>= 4)] = 0;
}

/// New boxes for these items where they are: their leaves are written and the blocks above them
/// done again, what comes of it being that of fill_packed to the byte. Levels of no more blocks
/// than there are items are done whole.
inline void refit_packed_items(const PackedView& to, const Box* boxes, const MovedItems& moved,
                               Box* bounds, Stream stream) {
    if (to.n == 0 || moved.n == 0)
        return;
    launch(stream, blocks_for(moved.n, packed_threads), packed_threads, move_packed_items,
           to.blocks, boxes, moved);
    unsigned level = 0;
    for (; level < to.depth && to.size(level) > moved.n; ++level)
        launch(stream, blocks_for(std::size_t{moved.n} * to.width, packed_threads), packed_threads,
               refit_touched, to.blocks, packed_level(to, level), 4 * (level + 1), moved, bounds);
    if (level > 0)
        launch(stream, blocks_for(moved.n, packed_threads), packed_threads, forget_touched, to,
               level, moved);
    for (; level < to.depth; ++level)
        fill_level(to, level, bounds, stream);
}

} // namespace boxwood::cuda
