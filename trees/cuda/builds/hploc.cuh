#pragma once

#include "trees/cuda/builds/binary.cuh"

namespace boxwood::cuda {

/// H-PLOC over n boxes in the order of their codes (Benthin, Meister, Barczak, Mehta, Woop 2024,
/// "H-PLOC: Hierarchical Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
/// Construction"). Each lane climbs the binary radix tree; where more than `kept` items come
/// together, the warp merges their clusters until no more than that are left, each with the nearest
/// of `radius` clusters to either side. Which thread comes first changes nothing: two clusters make
/// the node before the first slot of the later one.
struct HplocView {
    static constexpr unsigned kept = 16, radius = 8;

    BinaryView tree;
    const std::uint64_t* codes; ///< ascending
    const Box* boxes;           ///< of the items
    std::uint64_t* clusters;    ///< n; the first slot of each above a node or slot
    std::uint32_t* met;         ///< n
};

/// A warp's part of the work.
class HplocWarp {
  public:
    __device__ explicit HplocWarp(const HplocView& to) : to_(to), lane_(threadIdx.x % 32) {}

    __device__ void climb(std::uint32_t slot) {
        const std::uint32_t slots = to_.tree.n;
        std::uint32_t first = slot, last = slot, split = 0;
        bool goes_on = slot < slots;
        while (__any_sync(~0u, goes_on)) {
            if (goes_on) {
                const bool is_left =
                    first == 0 ||
                    (last + 1 < slots && parting(to_.codes, last + 1) < parting(to_.codes, first));
                __threadfence();
                const std::uint32_t other = last - first + 1 == slots
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
            __syncwarp(); // a vote alone lets no lane see what another one's fence let it see
            const std::uint32_t size = last - first + 1;
            const bool is_all = goes_on && size == slots;
            for (unsigned merging = __ballot_sync(~0u, goes_on && (size > to_.kept || is_all));
                 merging != 0; merging &= merging - 1) {
                const auto from = static_cast<unsigned>(__ffs(static_cast<int>(merging)) - 1);
                merge(__shfl_sync(~0u, first, from), __shfl_sync(~0u, split, from),
                      __shfl_sync(~0u, last, from), __shfl_sync(~0u, is_all, from));
            }
            __syncwarp(); // what its lanes wrote is there before one of them says so
        }
    }

  private:
    /// One per lane, those of a warp in the order of their first slots.
    struct Cluster {
        std::uint32_t ref = nobody, first = 0; ///< a node or slot; its first slot
        Box box;
    };

    /// The clusters of slots [first, split) and [split, last] are merged until `kept` are left, or
    /// one if these are all slots.
    __device__ void merge(std::uint32_t first, std::uint32_t split, std::uint32_t last,
                          bool is_all) {
        Cluster cluster;
        unsigned n = load(first, split, 0, cluster);
        n += load(split, last + 1, n, cluster);
        if (lane_ < n)
            cluster.box = box_of(cluster.ref);
        for (const unsigned enough = is_all ? 1 : to_.kept; n > enough;)
            n = merge_once(n, cluster);
        if (is_all) {
            if (lane_ == 0)
                *to_.tree.root = cluster.ref;
            return;
        }
        // What a part holds is ended by `nobody`, unless it fills it.
        if (lane_ < to_.kept && first + lane_ <= last)
            to_.clusters[first + lane_] =
                lane_ < n ? std::uint64_t{cluster.first} << 32 | cluster.ref : nobody;
        __threadfence();
    }

    /// Clusters of a part, up to `kept`, go to the lanes from `at` on. Gives their number.
    __device__ unsigned load(std::uint32_t begin, std::uint32_t end, unsigned at,
                             Cluster& cluster) {
        const unsigned i = lane_ - at;
        const bool may = lane_ >= at && i < to_.kept && begin + i < end;
        const std::uint64_t found = may ? __ldcg(to_.clusters + begin + i) : nobody;
        const unsigned none = __ballot_sync(~0u, static_cast<std::uint32_t>(found) == nobody) >> at;
        // Those before the first lane without one.
        const unsigned n =
            none != 0 ? static_cast<unsigned>(__ffs(static_cast<int>(none)) - 1) : 32 - at;
        if (may && i < n) {
            cluster.ref = static_cast<std::uint32_t>(found);
            cluster.first = static_cast<std::uint32_t>(found >> 32);
        }
        return n;
    }

    __device__ Box box_of(std::uint32_t ref) const {
        return RadixTreeView::is_leaf(ref) ? to_.boxes[to_.tree.items[RadixTreeView::slot(ref)]]
                                           : from_other(&to_.tree.nodes[ref].box);
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
    __device__ unsigned merge_once(unsigned n, Cluster& cluster) {
        // The nearest: least area together; of equal ones the nearer on the curve, then the lower.
        float least = Box::inf;
        unsigned nearest = lane_;
        const auto offer = [&](float area, unsigned from) {
            if (lane_ < n && from < n && (nearest == lane_ || area < least)) {
                least = area;
                nearest = from;
            }
        };
        for (unsigned step = 1; step <= to_.radius; ++step) {
            // Once for both: the lower one takes it from the upper.
            const unsigned lower = lane_ - step;
            Box together = from_lane(cluster.box, lane_ >= step ? lower : lane_);
            together.extend(cluster.box);
            const float area = area_of(together);
            const float above = __shfl_sync(~0u, area, (lane_ + step) % 32);
            offer(area, lower);
            offer(above, lane_ + step);
        }
        const unsigned choice_of_nearest = __shfl_sync(~0u, nearest, nearest);
        bool merges = lane_ < n && nearest != lane_ && choice_of_nearest == lane_;
        if (!__any_sync(~0u, merges)) { // a ring of equal areas, or none is a number: the first two
            merges = lane_ < 2;
            if (merges)
                nearest = 1 - lane_;
        }
        const bool makes = merges && lane_ < nearest, goes = merges && nearest < lane_;
        const unsigned going = __ballot_sync(~0u, goes);
        const std::uint32_t other = __shfl_sync(~0u, cluster.ref, nearest),
                            place = __shfl_sync(~0u, cluster.first, nearest);
        Box together = from_lane(cluster.box, nearest);
        together.extend(cluster.box);
        if (makes) {
            to_.tree.nodes[place - 1] = {together, cluster.ref, other};
            cluster.ref = place - 1;
            cluster.box = together;
        }
        // Lane i takes the i-th of those that stay.
        const unsigned stay = ~going & (n == 32 ? ~0u : (1u << n) - 1);
        const unsigned left = static_cast<unsigned>(__popc(stay));
        const unsigned from = lane_ < left ? nth_set(stay, lane_) : lane_;
        cluster.ref = __shfl_sync(~0u, cluster.ref, from);
        cluster.first = __shfl_sync(~0u, cluster.first, from);
        cluster.box = from_lane(cluster.box, from);
        return left;
    }

    /// Half of it; a measure, in floats.
    __device__ static float area_of(const Box& box) {
        const Vec3<float> e = box.max - box.min;
        return e.x * e.y + e.y * e.z + e.z * e.x;
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
    if (slot == 0)
        *to.tree.root = RadixNode::leaf_bit; // of one item; else written over
    if (slot < to.tree.n) {
        to.clusters[slot] = std::uint64_t{slot} << 32 | slot | RadixNode::leaf_bit;
        to.met[slot] = nobody;
    }
}

/// The items are in place.
inline void make_hploc(const HplocView& to, Stream stream) {
    const std::size_t blocks = blocks_for(to.tree.n, radix_threads);
    launch(stream, blocks, radix_threads, start_hploc, to);
    if (to.tree.n > 1)
        launch(stream, blocks, radix_threads, build_hploc, to);
}

} // namespace boxwood::cuda
