#pragma once

#include "trees/tree.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace boxwood::detail {

/// A subtree on its way to the root. Leaves are numbered along the curve from 0; each merge gets
/// the next number.
struct PlocCluster {
    Box box;
    std::uint32_t node, count;
};

/// An inner node by the numbers of its children, with the items below.
struct PlocMerge {
    std::uint32_t left, right, left_count, count;
};

/// Clusters that are neighbours along the curve, merged among themselves: some 90 kB, all that the
/// rounds work on.
class PlocTile {
  public:
    static constexpr std::size_t capacity = 2048;

    /// Starts over with no clusters.
    void clear() { size_ = 0; }
    void add(const PlocCluster& cluster) {
        const float at[6] = {cluster.box.min.x, cluster.box.min.y, cluster.box.min.z,
                             cluster.box.max.x, cluster.box.max.y, cluster.box.max.z};
        for (int k = 0; k < 6; ++k)
            at_[k][size_] = at[k];
        node_[size_] = cluster.node;
        count_[size_] = cluster.count;
        ++size_;
    }

    /// Merges until no more than `wanted` (at least 1) clusters are left, in the order of the
    /// curve. Writes the merges, children before parents, and numbers them from `first_node` on.
    /// Returns how many there are: at most the clusters added, less one.
    std::size_t reduce(std::size_t wanted, std::size_t radius, std::uint32_t first_node,
                       PlocMerge* merges);

    std::size_t size() const { return size_; }
    /// Its box but for rounding where coordinates are beyond 2^40 or all below 2^-40.
    PlocCluster operator[](std::size_t i) const {
        return {{{unscale_ * at_[0][i], unscale_ * at_[1][i], unscale_ * at_[2][i]},
                 {unscale_ * at_[3][i], unscale_ * at_[4][i], unscale_ * at_[5][i]}},
                node_[i],
                count_[i]};
    }

    // For the search alone, which is compiled once per instruction set.
    static constexpr std::size_t margin = 64; ///< read beyond the clusters: 31 + 16 lanes
    static constexpr std::uint32_t place_bits = 63;
    using Row = float[capacity + margin];
    struct View {
        const Row* at; ///< min x, y, z, max x, y, z
        std::uint32_t* nearest;
        std::size_t size;
    };

  private:
    void scale();
    void pad();
    template <class StepOf> void merge(const StepOf& step_of);
    void merge_mutual();
    void merge_neighbours();

    alignas(64) Row at_[6];
    std::uint32_t node_[capacity + margin], count_[capacity + margin];
    /// Of each cluster the key of the pair that it and its nearest make.
    std::uint32_t nearest_[capacity + margin];
    std::size_t size_ = 0;
    float unscale_ = 1;
    PlocMerge* merges_ = nullptr;
    std::size_t n_merges_ = 0;
    std::uint32_t first_node_ = 0;
};

} // namespace boxwood::detail
