#pragma once

#include "trees/cuda/builds/packed.cuh"
#include "trees/cuda/queries/pairs_to.cuh"

namespace boxwood::cuda {

constexpr unsigned traversal_threads = 256, traversal_warps = traversal_threads / 32;

/// A warp's way through a packed layout: up to two blocks are opened at a time, one by each half of
/// the warp.
class PackedTraversal {
  public:
    /// Two blocks of one level are opened at a time, so that on the stack each level has at most
    /// the 32 lanes of one step, and the levels above it 30.
    static constexpr unsigned room = 2 + 30 * PackedView::max_levels;

    /// stack: the warp's own `room` numbers in shared memory.
    __device__ PackedTraversal(const PackedView& tree, std::uint32_t* stack)
        : tree_(tree), stack_(stack), lane_(threadIdx.x % 32) {}

    /// meet(lanes, leaf, bounds), for all lanes together: of the leaves below block `start` those
    /// whose bounds `admits` takes and which are leaf `from` or a later one: `leaf` of each of
    /// `lanes`, and its bounds.
    template <class Admits, class Meet>
    __device__ void run(std::uint32_t start, std::uint32_t from, const Admits& admits,
                        const Meet& meet) {
        if (start < tree_.leaves())
            return meet(1u, start,
                        half_warp_bounds(lane_box(tree_.blocks[start], lane_ % tree_.width)));
        std::uint32_t size = 1;
        if (lane_ == 0)
            stack_[0] = start;
        while (size > 0) {
            __syncwarp();
            const std::uint32_t top = stack_[size - 1], next = stack_[size > 1 ? size - 2 : 0];
            __syncwarp(); // all have read what is now written over
            unsigned level = 1;
            while (top >= tree_.first[level + 1])
                ++level;
            const bool two =
                size > 1 && next >= tree_.first[level] && next < tree_.first[level + 1];
            size -= two ? 2 : 1;

            const bool is_first = lane_ < tree_.width;
            const std::uint32_t block = is_first ? top : next, k = lane_ % tree_.width;
            const std::uint32_t child = (block - tree_.first[level]) * tree_.width + k;
            // The last leaf below the child, and one more.
            const std::uint64_t end = (std::uint64_t{child} + 1) << (4 * (level - 1));
            Box bounds;
            bool hit = (is_first || two) && child < tree_.size(level - 1) && end > from;
            if (hit) {
                bounds = lane_box(tree_.blocks[block], k);
                hit = admits(bounds);
            }
            const unsigned hits = __ballot_sync(~0u, hit);
            if (level == 1) {
                meet(hits, child, bounds);
                continue;
            }
            if (hit)
                stack_[size + lanes_below(hits)] = tree_.first[level - 1] + child;
            size += static_cast<std::uint32_t>(__popc(hits));
        }
    }

  private:
    const PackedView& tree_;
    std::uint32_t* stack_;
    unsigned lane_;
};

/// The lowest lane of the mask, which is not 0, and takes it out.
__device__ inline unsigned take_lane(unsigned& mask) {
    const auto lane = static_cast<unsigned>(__ffs(static_cast<int>(mask)) - 1);
    mask &= mask - 1;
    return lane;
}

/// Of the lanes of the mask two by two, until none is left: of this half of the warp that lane, and
/// whether there is one.
class LanesByTwo {
  public:
    __device__ explicit LanesByTwo(unsigned lanes) : lanes_(lanes) {}
    __device__ bool next() {
        if (lanes_ == 0)
            return false;
        const unsigned first = take_lane(lanes_);
        const bool is_first = threadIdx.x % 32 < PackedView::width, two = lanes_ != 0;
        const unsigned second = two ? take_lane(lanes_) : first;
        lane = is_first ? first : second;
        is_there = is_first || two;
        return true;
    }
    unsigned lane = 0;
    bool is_there = false;

  private:
    unsigned lanes_;
};

} // namespace boxwood::cuda
