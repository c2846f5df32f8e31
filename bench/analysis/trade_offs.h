#pragma once

#include "results/results.h"

#include <vector>

namespace boxwood::bench {

/// Of each job the contenders that no other betters in both build and query, by rising build time,
/// and after how many queries each has paid for itself against the one before it: NaN where one of
/// the two differences is within the noise floor. Needs Cell::status and /medians.
std::vector<results::BreakEven> trade_offs_of(const results::Results& results, double floor);

} // namespace boxwood::bench
