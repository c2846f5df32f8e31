#pragma once

#include "results/results.h"

#include <vector>

namespace boxwood::bench {

/// Of each job the contenders that no other betters in both build and query, by rising build time,
/// and after how many queries each has paid for itself against the one before it: NaN for the
/// first, and where one of the two differences is within the noise floor. Needs Cell::status and
/// /medians.
std::vector<results::BreakEven> trade_offs_of(const results::Results& results, double floor);

/// Sets TreeRow::on_front: of each job the right contenders that no other betters in both the time
/// to build and the surface-area cost of the tree; of two whose times differ by less than the noise
/// floor the better tree. Needs Cell::status and /medians.
void set_tree_fronts(results::Results& results, double floor);

} // namespace boxwood::bench
