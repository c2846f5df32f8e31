#pragma once

#include "trees/layouts/packed.h"

#include <cstddef>

namespace boxwood::detail {

/// When a new order of moving boxes pays. As boxes move, blocks loosen and queries meet more of
/// them; a new order ends that, at a price. Both are estimated by what was counted, never by the
/// clock, in nanoseconds per item of one thread of a machine of 2023.
/// While motion goes on as it is, the mean cost of a frame is least if the order is made anew once
/// the excess of the next frame exceeds the mean cost of those since the last order, that
/// included. What boxes have done once, and do no more, is ended when it has cost `patience` times
/// as much as an order.
class OrderAge {
  public:
    double patience = 1.5;

    /// Forgets all but `patience`. The order is fresh, and no motion has been seen.
    void start(double price, const PackedLayout& layout, Boxes boxes);
    /// The same, for queries that are known to take so much over a fresh order.
    void start(double price, double query);
    /// The order was made anew, or in part, at this price above that of leaving it.
    void renewed(double price, const PackedLayout& layout, Boxes boxes);
    void renewed(double price, double query);
    /// The boxes moved, the order stayed: `looseness` is the surface of all blocks over what it was
    /// when all of the order was fresh.
    void aged(double looseness);
    /// What queries lose by that.
    double excess(double looseness) const;

    /// Whether a new order pays rather than the excess of the newest frame.
    bool is_due() const;
    /// The same of the frame to come, as it will be if motion goes on as it was.
    bool is_due_next() const;
    /// What queries take over a fresh order.
    double query_cost() const { return fresh_query_; }

  private:
    bool is_due(double excess, std::size_t age, double before) const;
    void measure(const PackedLayout& layout, Boxes boxes);

    double fresh_query_ = 0;
    double price_ = 0;
    double before_ = 0; ///< excess of the frames since the order, without the newest
    double newest_ = 0;
    double first_ = 0;         ///< of the first frame after an order, when last seen
    std::size_t frames_ = 0;   ///< since the order
    std::size_t renewals_ = 0; ///< since the start
    std::size_t in_a_row_ = 0; ///< of them without a frame between
};

} // namespace boxwood::detail
