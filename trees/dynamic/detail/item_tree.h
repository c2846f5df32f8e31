#pragma once

#include "trees/dynamic/detail/changed_items.h"
#include "trees/dynamic/detail/moving_tree.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boxwood::detail {

/// Boxes of numbered items that come, go and move between queries, and the packed tree over them,
/// which is brought up to date when it is wanted: refitted where few moved, ordered again where
/// queries have lost as much by a bad order as a new one costs.
class ItemTree {
  public:
    /// A valid box, or Box{} for an item that is absent; up to then all are.
    void set(std::uint32_t item, const Box& box) {
        if (item >= boxes_.size())
            boxes_.resize(std::size_t{item} + 1);
        boxes_[item] = box;
        changed_.add(item, boxes_.size());
    }
    void clear();

    /// What a query takes in a tree of good order, in nanoseconds of a machine of 2023: of one box,
    /// and of all pairs for each item.
    static constexpr double per_query = 400, per_item = 20;

    /// Brings the tree up to date, for a query that would take so much. Whether by a new order.
    bool refresh(double query);
    /// What such a query loses by the order as it is.
    double excess(double query) const { return (ratio_ - 1) * query; }
    /// Whether losses add up to more than the cost of a new order.
    bool is_worth_order(double lost) const {
        return lost > per_order * static_cast<double>(boxes_.size());
    }
    void reorder();

    const PackedLayout& layout() const { return tree_.layout(); }
    const Box& box(std::uint32_t item) const { return boxes_[item]; }
    Boxes boxes() const { return boxes_; }
    std::size_t bytes() const { return tree_.bytes() + boxes_.capacity() * sizeof(Box); }
    /// How often all items were ordered again.
    std::size_t orders() const { return orders_; }

  private:
    static constexpr double per_order = 25; ///< nanoseconds for each item

    void note_ratio();

    std::vector<Box> boxes_; ///< by item
    ChangedItems changed_;   ///< since the tree was up to date
    MovingTree tree_;
    double ratio_ = 1;           ///< of areas, as it was when last measured
    std::size_t unmeasured_ = 0; ///< items that changed since then
    std::size_t orders_ = 0;
};

} // namespace boxwood::detail
