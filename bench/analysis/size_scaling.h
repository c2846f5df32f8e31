#pragma once

#include "bench/analysis/times.h"

#include <map>
#include <vector>

namespace boxwood::bench {

inline constexpr std::size_t min_sizes = 4; ///< fewer give no exponent

/// Time as a power of n. The exponent is the least-squares slope of log time over log n, fitted
/// round by round, then the median over the rounds that have every size; `off_line` the farthest
/// factor less 1 of the median times from the line through them.
struct PowerOfN {
    MedianInterval exponent;
    double off_line = unknown;
};
PowerOfN power_of_n(const std::map<double, const Times::Rounds*>& times_by_n);

/// The exponents of all phases of whatever was timed at `min_sizes` sizes of one scene, with right
/// answers. Needs Cell::status.
std::vector<results::SizeScaling> size_scaling_of(const results::Results& results,
                                                  const Times& times);

} // namespace boxwood::bench
