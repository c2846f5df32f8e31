#pragma once

#include "trees/cuda/packed.cuh"
#include "trees/cuda/pairs_to.cuh"

namespace boxwood::cuda {

constexpr unsigned pair_threads = 256, pair_warps = pair_threads / 32;
/// Two blocks of one level are opened at a time, so that on the stack each level has at most the 32
/// lanes of one step, and the levels above it 30.
constexpr unsigned pair_stack = 2 + 30 * PackedView::max_levels;

/// One leaf of `a` against `b`, by a warp: up to two blocks of `b` are opened at a time, one by
/// each half of the warp. Within one layout (is_self) only leaves from the own one on, each pair
/// once.
template <bool is_self, Pass pass> class LeafPairs {
  public:
    __device__ LeafPairs(const PackedView& a, const PackedView& b, const PairsTo& to,
                         std::uint32_t leaf, std::uint32_t* stack)
        : a_(a), b_(b), to_(to), leaf_(leaf), stack_(stack), lane_(threadIdx.x % 32),
          at_(pass == Pass::fill ? to.at[leaf] : 0) {}

    __device__ void run() {
        const Box bounds = half_warp_bounds(lane_box(a_.blocks[leaf_], k()));
        if (b_.depth == 1) {
            meet(0);
        } else {
            std::uint32_t size = 1;
            if (lane_ == 0)
                stack_[0] = b_.root();
            while (size > 0) {
                __syncwarp();
                const std::uint32_t top = stack_[size - 1], next = stack_[size > 1 ? size - 2 : 0];
                __syncwarp(); // all have read what is now written over
                unsigned level = 1;
                while (top >= b_.first[level + 1])
                    ++level;
                const bool two = size > 1 && next >= b_.first[level] && next < b_.first[level + 1];
                size = open(half() == 0 ? top : next, half() == 0 || two, level, bounds,
                            size - (two ? 2 : 1));
            }
        }
        if constexpr (pass == Pass::count) {
            for (unsigned step = 16; step > 0; step /= 2)
                at_ += __shfl_xor_sync(~0u, at_, step);
            if (lane_ == 0)
                to_.at[leaf_] = at_;
        }
    }

  private:
    __device__ unsigned half() const { return lane_ / 16; }
    __device__ unsigned k() const { return lane_ % 16; }
    __device__ unsigned below(unsigned mask) const {
        return static_cast<unsigned>(__popc(mask & ((1u << lane_) - 1)));
    }

    /// Of nodes of one level: pushes the children that overlap, or meets them if they are leaves.
    __device__ std::uint32_t open(std::uint32_t node, bool has, unsigned level, const Box& bounds,
                                  std::uint32_t size) {
        const std::uint32_t child = (node - b_.first[level]) * b_.width + k();
        // The last leaf below the child, and one more.
        const std::uint64_t end = (std::uint64_t{child} + 1) << (4 * (level - 1));
        const bool hit =
            has && (!is_self || end > leaf_) && overlaps(bounds, lane_box(b_.blocks[node], k()));
        unsigned hits = __ballot_sync(~0u, hit);
        if (level > 1) {
            if (hit)
                stack_[size + below(hits)] = b_.first[level - 1] + child;
            return size + static_cast<std::uint32_t>(__popc(hits));
        }
        for (; hits != 0; hits &= hits - 1)
            meet(__shfl_sync(~0u, child, static_cast<unsigned>(__ffs(static_cast<int>(hits)) - 1)));
        return size;
    }

    /// Each lane has one slot of leaf c of `b`, and tests eight of the sixteen of `a`.
    __device__ void meet(std::uint32_t c) {
        const Box mine = lane_box(b_.blocks[c], k());
        for (unsigned i = 0; i < 8; ++i) {
            const unsigned q = half() * 8 + i;
            emit((!is_self || c != leaf_ || q < k()) &&
                     overlaps(lane_box(a_.blocks[leaf_], q), mine),
                 leaf_ * a_.width + q, c * b_.width + k());
        }
    }

    __device__ void emit(bool hit, std::uint32_t slot_a, std::uint32_t slot_b) {
        if constexpr (pass == Pass::count) {
            at_ += hit;
            return;
        }
        const unsigned hits = __ballot_sync(~0u, hit);
        if (hits == 0)
            return;
        const auto n = static_cast<std::uint64_t>(__popc(hits));
        std::uint64_t first = at_;
        if constexpr (pass == Pass::capped) {
            if (lane_ == 0)
                first = to_.take(static_cast<unsigned>(n));
            first = __shfl_sync(~0u, first, 0);
        }
        const std::uint64_t place = first + below(hits);
        if (hit && (pass == Pass::fill || place < to_.room))
            to_.pairs[place] = pair_of<is_self>(a_.items[slot_a], b_.items[slot_b]);
        at_ += n;
    }

    const PackedView &a_, &b_;
    const PairsTo& to_;
    std::uint32_t leaf_;
    std::uint32_t* stack_;
    unsigned lane_;
    std::uint64_t at_;
};

/// A warp per leaf of `a`.
template <bool is_self, Pass pass>
__global__ void packed_pairs(PackedView a, PackedView b, PairsTo to) {
    __shared__ std::uint32_t stacks[pair_warps][pair_stack];
    const unsigned warp = threadIdx.x / 32;
    const std::uint32_t leaf = blockIdx.x * pair_warps + warp;
    if (leaf < a.leaves()) // all lanes of the warp or none
        LeafPairs<is_self, pass>(a, b, to, leaf, stacks[warp]).run();
}

/// One pass over all pairs of two layouts, or with is_self of one (b is then a).
template <bool is_self, Pass pass>
void find_packed_pairs(const PackedView& a, const PackedView& b, const PairsTo& to, Stream stream) {
    if (a.n > 0 && b.n > 0)
        launch(stream, blocks_for(a.leaves(), pair_warps), pair_threads,
               packed_pairs<is_self, pass>, a, b, to);
}

} // namespace boxwood::cuda
