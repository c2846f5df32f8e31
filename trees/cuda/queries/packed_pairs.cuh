#pragma once

#include "trees/cuda/queries/packed_traversal.cuh"

namespace boxwood::cuda {

constexpr unsigned pair_threads = traversal_threads, pair_warps = traversal_warps;
constexpr unsigned pair_stack = PackedTraversal::room;

/// What a warp keeps in shared memory.
template <Pass pass> struct PairRoom {
    std::uint32_t stack[pair_stack];
    float planes[6][PackedView::width]; ///< of its leaf, as in its block
    std::uint32_t items[PackedView::width];
    Pair held[WarpAnswers<pass, Pair>::n_held];
};

/// One leaf of `a` against `b`, by a warp. Within one layout (is_self) only leaves from the own one
/// on, each pair once.
template <bool is_self, Pass pass> class LeafPairs {
  public:
    __device__ LeafPairs(const PackedView& a, const PackedView& b, const PairsTo& to,
                         std::uint32_t leaf, PairRoom<pass>& room)
        : b_(b), leaf_(leaf), room_(room), mine_(lane_box(a.blocks[leaf], k())),
          bounds_(half_warp_bounds(mine_)), traversal_(b, room.stack),
          answers_(to, leaf, room.held) {
        if (threadIdx.x % 32 < a.width) {
            for (int axis = 0; axis < 3; ++axis) {
                room.planes[axis][k()] = mine_.min[axis];
                room.planes[3 + axis][k()] = mine_.max[axis];
            }
            room.items[k()] = a.items[leaf * a.width + k()];
        }
        __syncwarp();
    }

    __device__ void run() {
        traversal_.run(
            b_.root(), is_self ? leaf_ : 0, [&](const Box& box) { return overlaps(bounds_, box); },
            [&](unsigned lanes, std::uint32_t leaf, const Box& box) {
                for (LanesByTwo two(lanes); two.next();)
                    meet(two.is_there, __shfl_sync(~0u, leaf, two.lane), box_of(box, two.lane));
            });
        answers_.finish();
    }

  private:
    __device__ static unsigned k() { return threadIdx.x % PackedView::width; }
    /// Of those of a vote that half of the warp which this lane is in.
    __device__ static unsigned half(unsigned lanes) {
        return lanes >> (threadIdx.x % 32 / PackedView::width * PackedView::width) & 0xffffu;
    }
    __device__ static Box box_of(const Box& box, unsigned lane) {
        Box of;
        for (int axis = 0; axis < 3; ++axis) {
            of.min[axis] = __shfl_sync(~0u, box.min[axis], lane);
            of.max[axis] = __shfl_sync(~0u, box.max[axis], lane);
        }
        return of;
    }
    __device__ Box box_of_a(unsigned q) const {
        const auto& plane = room_.planes;
        return {{plane[0][q], plane[1][q], plane[2][q]}, {plane[3][q], plane[4][q], plane[5][q]}};
    }

    /// Each half of the warp has a leaf c of `b`, each lane one slot of it: the boxes of it that
    /// meet the bounds of `a` against those of `a` that meet its bounds.
    __device__ void meet(bool is_there, std::uint32_t c, const Box& of_c) {
        const Box other = lane_box(b_.blocks[c], k());
        const bool can = is_there && overlaps(bounds_, other);
        unsigned of_a = half(__ballot_sync(~0u, is_there && overlaps(mine_, of_c)));
        if (half(__ballot_sync(~0u, can)) == 0)
            of_a = 0;
        while (__any_sync(~0u, of_a != 0)) {
            const unsigned q = of_a != 0 ? take_lane(of_a) : PackedView::width;
            answers_.add(
                can && q < PackedView::width && (!is_self || c != leaf_ || q < k()) &&
                    overlaps(box_of_a(q), other),
                [&] { return pair_of<is_self>(room_.items[q], b_.items[c * b_.width + k()]); });
        }
    }

    const PackedView& b_;
    std::uint32_t leaf_;
    PairRoom<pass>& room_;
    Box mine_, bounds_; ///< of this lane's slot of the leaf, and of the leaf
    PackedTraversal traversal_;
    WarpAnswers<pass, Pair> answers_;
};

/// A warp per leaf of `a`, of those from `first` on to `end`.
template <bool is_self, Pass pass>
__global__ void packed_pairs(PackedView a, PackedView b, PairsTo to, std::uint32_t first,
                             std::uint32_t end) {
    __shared__ PairRoom<pass> rooms[pair_warps];
    const unsigned warp = threadIdx.x / 32;
    const std::uint32_t leaf = first + blockIdx.x * pair_warps + warp;
    if (leaf < end) // all lanes of the warp or none
        LeafPairs<is_self, pass>(a, b, to, leaf, rooms[warp]).run();
}

/// One pass over all pairs of two layouts, or with is_self of one (b is then a).
template <bool is_self, Pass pass>
void find_packed_pairs(const PackedView& a, const PackedView& b, const PairsTo& to, Stream stream) {
    if (a.n > 0 && b.n > 0)
        launch(stream, blocks_for(a.leaves(), pair_warps), pair_threads,
               packed_pairs<is_self, pass>, a, b, to, 0u, a.leaves());
}

} // namespace boxwood::cuda
