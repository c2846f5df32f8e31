#pragma once

#include "trees/dynamic/detail/item_tree.h"
#include "trees/dynamic/detail/lane_groups.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace boxwood::detail {

/// The boxes of bodies in a packed tree, which is brought up to date when it is wanted, and a list
/// of those that no tree holds well: without bounds, or beyond 1e18.
/// Threads: any number of them may call const members at the same time.
class BodyTree {
  public:
    /// A new box; the empty one for a body that is none or has no point.
    void set(std::uint32_t body, const Box& box);
    void clear();
    void note_groups() { groups_are_stale_ = true; } ///< those of some body have changed

    bool is_stale() const { return is_stale_; }
    bool groups_are_stale() const { return groups_are_stale_; }
    /// Up to date from here on, for a query of all pairs, or of one box.
    const PackedLayout& layout() const { return layout_for(cost_of_all()); }
    const PackedLayout& layout_for_one() const { return layout_for(ItemTree::per_query); }
    /// The groups of its lanes; after layout().
    const LaneGroups& lane_groups(std::span<const Groups> by_body) const;

    std::span<const std::uint32_t> wide() const { return wide_; } ///< not in the tree
    std::size_t bytes() const {
        const std::lock_guard lock(changing_);
        return tree_.bytes();
    }
    std::size_t group_bytes() const {
        const std::lock_guard lock(changing_);
        return lane_groups_.bytes();
    }

    /// Whether a tree does not hold such a box well; an empty one it does.
    static bool is_wide(const Box& box);

  private:
    double cost_of_all() const { return ItemTree::per_item * static_cast<double>(is_wide_.size()); }
    const PackedLayout& layout_for(double cost) const; ///< nanoseconds, ItemTree::refresh

    std::vector<std::uint8_t> is_wide_; ///< by body
    std::vector<std::uint32_t> wide_;

    mutable std::mutex changing_; ///< whoever changes what queries read
    mutable std::atomic<bool> is_stale_ = false, groups_are_stale_ = true;
    mutable ItemTree tree_;
    mutable double lost_ = 0; ///< by queries in the tree as it is, nanoseconds
    mutable LaneGroups lane_groups_;
};

} // namespace boxwood::detail
