#pragma once

#include "trees/cuda/queries/packed_traversal.cuh"

namespace boxwood::cuda {

constexpr unsigned pair_threads = traversal_threads, pair_warps = traversal_warps;
constexpr unsigned pair_stack = PackedTraversal::room;

/// One leaf of `a` against `b`, by a warp. Within one layout (is_self) only leaves from the own one
/// on, each pair once.
template <bool is_self, Pass pass> class LeafPairs {
  public:
    __device__ LeafPairs(const PackedView& a, const PackedView& b, const PairsTo& to,
                         std::uint32_t leaf, std::uint32_t* stack)
        : a_(a), b_(b), leaf_(leaf), traversal_(b, stack), answers_(to, leaf) {}

    __device__ void run() {
        const Box bounds = half_warp_bounds(lane_box(a_.blocks[leaf_], k()));
        traversal_.run(
            b_.root(), is_self ? leaf_ : 0, [&](const Box& box) { return overlaps(bounds, box); },
            [&](unsigned lanes, std::uint32_t leaf) {
                while (lanes != 0)
                    meet(__shfl_sync(~0u, leaf, take_lane(lanes)));
            });
        answers_.finish();
    }

  private:
    __device__ static unsigned k() { return threadIdx.x % 16; }

    /// Each lane has one slot of leaf c of `b`, and tests eight of the sixteen of `a`.
    __device__ void meet(std::uint32_t c) {
        const Box mine = lane_box(b_.blocks[c], k());
        for (unsigned i = 0; i < 8; ++i) {
            const unsigned q = threadIdx.x % 32 / 16 * 8 + i;
            answers_.add((!is_self || c != leaf_ || q < k()) &&
                             overlaps(lane_box(a_.blocks[leaf_], q), mine),
                         [&] {
                             return pair_of<is_self>(a_.items[leaf_ * a_.width + q],
                                                     b_.items[c * b_.width + k()]);
                         });
        }
    }

    const PackedView &a_, &b_;
    std::uint32_t leaf_;
    PackedTraversal traversal_;
    WarpAnswers<pass, Pair> answers_;
};

/// A warp per leaf of `a`, of those from `first` on to `end`.
template <bool is_self, Pass pass>
__global__ void packed_pairs(PackedView a, PackedView b, PairsTo to, std::uint32_t first,
                             std::uint32_t end) {
    __shared__ std::uint32_t stacks[pair_warps][pair_stack];
    const unsigned warp = threadIdx.x / 32;
    const std::uint32_t leaf = first + blockIdx.x * pair_warps + warp;
    if (leaf < end) // all lanes of the warp or none
        LeafPairs<is_self, pass>(a, b, to, leaf, stacks[warp]).run();
}

/// One pass over all pairs of two layouts, or with is_self of one (b is then a).
template <bool is_self, Pass pass>
void find_packed_pairs(const PackedView& a, const PackedView& b, const PairsTo& to, Stream stream) {
    if (a.n > 0 && b.n > 0)
        launch(stream, blocks_for(a.leaves(), pair_warps), pair_threads,
               packed_pairs<is_self, pass>, a, b, to, 0u, a.leaves());
}

} // namespace boxwood::cuda
