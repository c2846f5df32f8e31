#pragma once

#include "trees/layouts/packed.h"

#include <cstddef>

namespace boxwood {

/// When a new order of moving boxes pays. As boxes move, blocks grow and queries meet more of them;
/// a new order ends that, at a cost. Both are estimated by what was counted, never by the clock, in
/// nanoseconds per item of one thread of a machine of 2023.
/// While motion goes on as it is, the mean cost of a frame is lowest if a new order is made once
/// the excess of the next frame exceeds the mean cost of those since the last order, that
/// included. What a motion that has ended costs is borne until it comes to `patience` times the
/// cost of an order.
class OrderDegradation {
  public:
    double patience = 1.5;

    /// Forgets all but `patience`. The order is new, and no motion has been seen.
    void start(double cost, const PackedLayout& layout, Boxes boxes);
    /// The same, for queries that are known to take so much over a new order.
    void start(double cost, double query);
    /// A new order was made, or a part of one, at this cost above that of leaving the old one.
    void reordered(double cost, const PackedLayout& layout, Boxes boxes);
    void reordered(double cost, double query);
    /// The boxes moved, the order stayed: `area_ratio` is the surface of all blocks over what it
    /// was when the whole order was new.
    void degraded(double area_ratio);
    /// What queries lose by that.
    double excess(double area_ratio) const;

    /// Whether a new order pays rather than the excess of the newest frame.
    bool is_due() const;
    /// The same of the frame to come, as it will be if motion goes on as it was.
    bool is_due_next() const;

  private:
    bool is_due(double excess, std::size_t age, double before) const;
    void measure(const PackedLayout& layout, Boxes boxes);

    double fresh_query_ = 0;
    double cost_ = 0;
    double before_ = 0; ///< excess of the frames since the order, without the newest
    double newest_ = 0;
    double first_ = 0;         ///< of the first frame after an order, when last seen
    std::size_t frames_ = 0;   ///< since the order
    std::size_t reorders_ = 0; ///< since the start
    std::size_t in_a_row_ = 0; ///< of them without a frame between
};

} // namespace boxwood
