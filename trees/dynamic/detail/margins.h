#pragma once

#include "trees/tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boxwood::detail {

/// A fat box around each item: while its box stays inside, the item keeps its place in the tree. An
/// absent box is inside any, and around it no other is: who comes back to his place still has it.
class Margins {
  public:
    /// share: the margin on each side, of the mean side of those present.
    void start(Boxes boxes, double share);
    /// The margin itself on each side.
    void start_wide(Boxes boxes, double margin);
    /// The items of `moved` whose boxes are not inside their fat boxes; valid until the next call.
    std::span<const std::uint32_t> left(Boxes boxes, std::span<const std::uint32_t> moved);
    /// Puts the fat boxes of these items around their present boxes.
    void follow(Boxes boxes, std::span<const std::uint32_t> items);
    const Box& fat(std::uint32_t item) const { return fat_[item]; }
    std::size_t bytes() const {
        return fat_.capacity() * sizeof(Box) + left_.capacity() * sizeof(std::uint32_t);
    }

  private:
    Box around(const Box& box) const;
    bool has_left(std::uint32_t item, const Box& box) const;

    float margin_ = 0;
    std::vector<Box> fat_;
    std::vector<std::uint32_t> left_;
};

} // namespace boxwood::detail
