#pragma once

#include "trees/executor.h"
#include "trees/tree.h"

#include <cstdint>

namespace boxwood::detail {

/// Whether the box is the empty one: its item is absent from this frame.
inline bool is_absent(const Box& box) { return box == Box{}; }

/// What one pass over all boxes of a frame finds.
struct Survey {
    Box centres; ///< bounds of the centres of those that are present
    bool some_absent = false;
};

/// Throws InvalidBox for the first box that is neither valid nor absent, and std::length_error as
/// `require_valid`.
Survey survey_of(Boxes boxes, const Executor& executor);
/// Throws the same for one item.
void require_present_or_absent(std::uint32_t item, const Box& box);

} // namespace boxwood::detail
