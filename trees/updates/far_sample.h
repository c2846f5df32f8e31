#pragma once

#include "trees/tree.h"

#include <cstdint>
#include <vector>

namespace boxwood {

/// About how many items have gone far since the start, by a sample of them: all if they are less
/// than a thousand, else one in sixteen, and a thousand of many.
class FarSample {
  public:
    /// reach: of the mean side of a box, or of the side of the cube that holds sixteen of them if
    /// that is larger; what moves a face by more has gone far.
    void start(Boxes boxes, double reach);
    /// Those who came or went are far.
    std::size_t about(Boxes boxes) const;
    std::size_t bytes() const {
        return items_.capacity() * sizeof(std::uint32_t) + boxes_.capacity() * sizeof(Box);
    }

  private:
    std::vector<std::uint32_t> items_; ///< ascending
    std::vector<Box> boxes_;           ///< at the start
    double reach_ = 0, items_each_ = 1;
};

} // namespace boxwood
