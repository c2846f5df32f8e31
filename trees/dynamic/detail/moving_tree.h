#pragma once

#include "trees/dynamic/detail/survey.h"
#include "trees/dynamic/update.h"
#include "trees/layouts/packed.h"
#include "trees/ordering/curve_order.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace boxwood::detail {

/// The order of HilbertBuilder, and after it the absent items.
Buffer<std::uint32_t> present_order(Boxes boxes, const Survey& survey, const Executor& executor);

/// What all update policies work on: moving boxes in an order, cut into a packed tree over that
/// order. The boxes given to every call are those of the newest frame, or around them; each is
/// valid, or absent, which has no place on the curve and comes after all others in a new order.
/// What a policy chooses is when the order changes and how.
class MovingTree {
  public:
    std::size_t size() const { return order_.size(); }
    const PackedLayout& layout() const { return layout_; }
    std::span<const std::uint32_t> order() const { return order_.span(); }
    std::size_t bytes() const;
    std::string fault() const;

    /// A new order: that of present_order. `known` of these boxes, if it is.
    void reorder(Boxes boxes, const std::optional<Survey>& known, const Executor& executor);
    /// A new order along a curve, to which `merge_in` can add: takes twice as long. Where boxes are
    /// too close together for that, as reorder.
    void order_to_merge(Boxes boxes, const std::optional<Survey>& known, const Executor& executor);
    /// This order of all items.
    void set_order(Boxes boxes, Buffer<std::uint32_t> order, const Executor& executor);
    /// Takes these items out of the order and puts them in where the curve passes them now, if the
    /// last order was made by order_to_merge or this; else as order_to_merge. Items ascending, all
    /// present.
    void merge_in(Boxes boxes, std::span<const std::uint32_t> items, const Executor& executor);
    /// Sorts the slots [begin, end) along the curve again.
    void sort_part(Boxes boxes, std::size_t begin, std::size_t end, const Executor& executor);

    /// The order stays. Of all boxes, in one pass over the levels; or of these items alone and of
    /// the blocks above while they change.
    void refit(Boxes boxes, const Executor& executor);
    void refit(Boxes boxes, std::span<const std::uint32_t> items);
    /// Whichever of the two is quicker.
    void refit(Boxes boxes, std::span<const std::uint32_t> items, const Executor& executor);
    /// To boxes of another kind, such as wider ones: the area ratio stays.
    void exchange(Boxes boxes, const Executor& executor);

    /// Sum of the surface areas of all blocks over that of the root: what a traversal has to pass.
    double surface() const { return layout_.surface(); }
    /// That over what it was when the order was last made or changed.
    double area_ratio() const;

    // Of the newest frame:
    UpdateStep step;
    std::optional<Survey> survey; ///< if nearly all of it moved

  private:
    MergeableOrder mergeable_order(Boxes boxes, const Survey& found, const Executor& executor);
    void place(Boxes boxes, const Executor& executor);
    void note_slots();

    PackedLayout layout_;
    Buffer<std::uint32_t> order_;   ///< slot -> item
    Buffer<std::uint32_t> slot_of_; ///< item -> slot, where it is known
    bool slots_known_ = false;
    double tight_ = 0; ///< the surface when the order was last made or changed

    // Of the curve: records of a code above an item, in the order of the slots.
    CurveGrid grid_;
    GroupOfBox group_ = nullptr;
    Buffer<std::uint64_t> records_, spare_, incoming_, incoming_spare_;
    std::vector<std::uint8_t> taken_out_; ///< by item, 0 between calls
    std::vector<Box> gathered_;
    std::vector<std::uint32_t> gathered_items_;
    std::vector<std::uint32_t> moved_slots_;
};

} // namespace boxwood::detail
