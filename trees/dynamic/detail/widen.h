#pragma once

#include "trees/executor.h"
#include "trees/tree.h"

#include <vector>

namespace boxwood::detail {

/// The median of a sample's sides, each the mean of a box's three; at least FLT_MIN, 1 if no box is
/// present.
double median_side(Boxes boxes);

/// Boxes whose faces are at least `margin` (at most FLT_MAX / 8) farther out, however rounded, or
/// at the end of all floats; the absent stay absent.
void widen_boxes(Boxes boxes, double margin, std::vector<Box>& widened, const Executor& executor);

} // namespace boxwood::detail
