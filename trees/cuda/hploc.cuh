#pragma once

#include "trees/cuda/lbvh.cuh"

namespace boxwood::cuda {

struct BinaryNode {
    Box box;
    std::uint32_t left, right; ///< a node, or an item with RadixNode::leaf_bit
};

/// H-PLOC over n boxes in the order of their codes (Benthin, Meister, Barczak, Mehta, Woop 2024,
/// "H-PLOC: Hierarchical Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
/// Construction"). Each lane climbs the binary radix tree; where more than `kept` items come
/// together, the warp merges their clusters until no more than that are left, each with the nearest
/// of `radius` clusters to either side.
struct HplocView {
    static constexpr unsigned kept = 16, radius = 8;

    std::uint32_t n;
    const std::uint64_t* codes; ///< ascending
    const std::uint32_t* items; ///< slot -> item
    const Box* boxes;           ///< of the items
    BinaryNode* nodes;          ///< n - 1
    std::uint32_t* clusters;    ///< n; at first items[i] with leaf_bit
    std::uint32_t* met;         ///< n; at first `nobody`
    std::uint32_t* n_nodes;     ///< 0 at first; the order of the nodes is that of a race
    std::uint32_t* root;
};

/// A warp's part of the work.
class HplocWarp {
  public:
    __device__ explicit HplocWarp(const HplocView& to) : to_(to), lane_(threadIdx.x % 32) {}

    __device__ void climb(std::uint32_t slot) {
        std::uint32_t first = slot, last = slot, split = 0;
        bool goes_on = slot < to_.n;
        while (__any_sync(~0u, goes_on)) {
            if (goes_on) {
                const bool is_left =
                    first == 0 ||
                    (last + 1 < to_.n && parting(to_.codes, last + 1) < parting(to_.codes, first));
                __threadfence();
                const std::uint32_t other =
                    last - first + 1 == to_.n
                        ? nobody
                        : atomicExch(to_.met + (is_left ? last : first - 1),
                                     is_left ? first : last);
                if (other == nobody) {
                    goes_on = false;
                } else if (is_left) {
                    split = last + 1;
                    last = other;
                } else {
                    split = first;
                    first = other;
                }
                __threadfence();
            }
            const std::uint32_t size = last - first + 1;
            const bool is_all = goes_on && size == to_.n;
            for (unsigned merging = __ballot_sync(~0u, goes_on && (size > to_.kept || is_all));
                 merging != 0; merging &= merging - 1) {
                const auto from =
                    static_cast<unsigned>(__ffs(static_cast<int>(merging)) - 1);
                merge(__shfl_sync(~0u, first, from), __shfl_sync(~0u, split, from),
                      __shfl_sync(~0u, last, from), __shfl_sync(~0u, is_all, from));
            }
        }
    }

  private:
    /// The clusters of slots [first, split) and [split, last], one per lane, are merged until
    /// `kept` are left, or one if these are all slots.
    __device__ void merge(std::uint32_t first, std::uint32_t split, std::uint32_t last,
                          bool is_all) {
        std::uint32_t cluster = nobody;
        unsigned n = load(first, split, 0, cluster);
        n += load(split, last + 1, n, cluster);
        Box box;
        if (lane_ < n)
            box = box_of(cluster);
        for (const unsigned enough = is_all ? 1 : to_.kept; n > enough;)
            n = merge_once(n, cluster, box);
        if (is_all) {
            if (lane_ == 0)
                *to_.root = cluster;
            return;
        }
        // What a part holds is ended by `nobody`, unless it fills it.
        if (lane_ < to_.kept && first + lane_ <= last)
            to_.clusters[first + lane_] = lane_ < n ? cluster : nobody;
        __threadfence();
    }

    /// Clusters of a part, up to `kept`, go to the lanes from `at` on. Gives their number.
    __device__ unsigned load(std::uint32_t begin, std::uint32_t end, unsigned at,
                             std::uint32_t& cluster) {
        const unsigned i = lane_ - at;
        const bool may = lane_ >= at && i < to_.kept && begin + i < end;
        const std::uint32_t found = may ? __ldcg(to_.clusters + begin + i) : nobody;
        const unsigned none = __ballot_sync(~0u, found == nobody) >> at;
        // Those before the first lane without one.
        const unsigned n = none != 0 ? static_cast<unsigned>(__ffs(static_cast<int>(none)) - 1)
                                     : 32 - at;
        if (may && i < n)
            cluster = found;
        return n;
    }

    __device__ Box box_of(std::uint32_t cluster) const {
        return RadixTreeView::is_leaf(cluster) ? to_.boxes[RadixTreeView::slot(cluster)]
                                               : from_other(&to_.nodes[cluster].box);
    }

    __device__ Box from_lane(const Box& box, unsigned lane) const {
        Box other;
        for (int axis = 0; axis < 3; ++axis) {
            other.min[axis] = __shfl_sync(~0u, box.min[axis], lane);
            other.max[axis] = __shfl_sync(~0u, box.max[axis], lane);
        }
        return other;
    }

    /// Merges the clusters that are each other's nearest, and closes the gaps.
    __device__ unsigned merge_once(unsigned n, std::uint32_t& cluster, Box& box) {
        // The nearest: least area together; of equal ones the nearer on the curve, then the lower,
        // so that two of them at least choose each other.
        float least = 0;
        unsigned nearest = lane_;
        for (unsigned step = 1; step <= to_.radius; ++step)
            for (const bool lower : {true, false}) {
                const unsigned from = lower ? lane_ - step : lane_ + step;
                const bool is_one = lane_ < n && from < n;
                Box together = from_lane(box, is_one ? from : lane_);
                together.extend(box);
                const float area = static_cast<float>(together.half_area());
                if (is_one && (nearest == lane_ || area < least)) {
                    least = area;
                    nearest = from;
                }
            }
        const unsigned choice_of_nearest = __shfl_sync(~0u, nearest, nearest);
        bool merges = lane_ < n && nearest != lane_ && choice_of_nearest == lane_;
        if (!__any_sync(~0u, merges)) { // ties in a ring: the first two then
            merges = lane_ < 2;
            if (merges)
                nearest = 1 - lane_;
        }
        const bool makes = merges && lane_ < nearest, goes = merges && nearest < lane_;
        const unsigned makers = __ballot_sync(~0u, makes), going = __ballot_sync(~0u, goes);
        std::uint32_t first_node = 0;
        if (lane_ == 0)
            first_node = atomicAdd(to_.n_nodes, static_cast<std::uint32_t>(__popc(makers)));
        first_node = __shfl_sync(~0u, first_node, 0);
        const std::uint32_t other = __shfl_sync(~0u, cluster, nearest);
        Box together = from_lane(box, nearest);
        together.extend(box);
        if (makes) {
            const std::uint32_t node =
                first_node + static_cast<std::uint32_t>(__popc(makers & ((1u << lane_) - 1)));
            to_.nodes[node] = {together, cluster, other};
            cluster = node;
            box = together;
        }
        // Lane i takes the i-th of those that stay.
        const unsigned stay = ~going & (n == 32 ? ~0u : (1u << n) - 1);
        const unsigned left = static_cast<unsigned>(__popc(stay));
        const unsigned from = lane_ < left ? nth_set(stay, lane_) : lane_;
        cluster = __shfl_sync(~0u, cluster, from);
        box = from_lane(box, from);
        __threadfence();
        return left;
    }

    /// The place of the i-th set bit, which there is.
    __device__ static unsigned nth_set(unsigned bits, unsigned i) {
        for (; i > 0; --i)
            bits &= bits - 1;
        return static_cast<unsigned>(__ffs(static_cast<int>(bits)) - 1);
    }

    const HplocView& to_;
    unsigned lane_;
};

/// A thread per slot.
__global__ void build_hploc(HplocView to) {
    HplocWarp(to).climb(blockIdx.x * blockDim.x + threadIdx.x);
}

__global__ void start_hploc(HplocView to) {
    const std::uint32_t slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot == 0) {
        *to.n_nodes = 0;
        *to.root = to.items[0] | RadixNode::leaf_bit; // of one item; else written over
    }
    if (slot < to.n) {
        to.clusters[slot] = to.items[slot] | RadixNode::leaf_bit;
        to.met[slot] = nobody;
    }
}

inline void make_hploc(const HplocView& to, Stream stream) {
    launch(stream, blocks_for(to.n, radix_threads), radix_threads, start_hploc, to);
    if (to.n > 1)
        launch(stream, blocks_for(to.n, radix_threads), radix_threads, build_hploc, to);
}

} // namespace boxwood::cuda
