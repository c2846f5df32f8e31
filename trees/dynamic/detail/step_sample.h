#pragma once

#include "trees/tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boxwood::detail {

/// How far some hundred of the items step in each frame.
class StepSample {
  public:
    void start(Boxes boxes);
    /// The step of each of them: 0 unless listed in `moved`, +inf for one that came or went.
    std::span<const float> follow(Boxes boxes, std::span<const std::uint32_t> moved);
    /// How many items each stands for.
    double items_each() const { return items_each_; }
    std::size_t bytes() const {
        return items_.capacity() * sizeof(std::uint32_t) + boxes_.capacity() * sizeof(Box) +
               steps_.capacity() * sizeof(float);
    }

  private:
    double items_each_ = 1;
    std::vector<std::uint32_t> items_; ///< ascending
    std::vector<Box> boxes_;           ///< of the last frame
    std::vector<float> steps_;
};

} // namespace boxwood::detail
