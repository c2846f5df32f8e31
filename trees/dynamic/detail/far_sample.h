#pragma once

#include "trees/tree.h"

#include <cstdint>
#include <vector>

namespace boxwood::detail {

/// About how many items have gone far since the start, by a sample of them: one in 32, but 256 at
/// least and 1024 at most.
class FarSample {
  public:
    /// reach: of the mean side of a box, or of the side of the cube that holds one of them if that
    /// is larger; what moves a face by more has gone far.
    void start(Boxes boxes, double reach);
    struct Found {
        std::size_t items = 0; ///< about how many have gone far; those who came or went have
        double share = 0;      ///< of the motion of all items, four times the reach at most each
    };
    Found look(Boxes boxes);
    /// Those whom the last look found far start here.
    void start_far(Boxes boxes);
    /// In the unit of the coordinates.
    double reach() const { return reach_; }
    std::size_t bytes() const {
        return (items_.capacity() + far_.capacity()) * sizeof(std::uint32_t) +
               boxes_.capacity() * sizeof(Box);
    }

  private:
    std::vector<std::uint32_t> items_; ///< ascending
    std::vector<Box> boxes_;           ///< at the start
    std::vector<std::uint32_t> far_;   ///< at the last look: which of items_
    std::size_t n_ = 0;                ///< of which these were taken
    double reach_ = 0, items_each_ = 1;
};

} // namespace boxwood::detail
