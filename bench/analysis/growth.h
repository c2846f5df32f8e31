#pragma once

#include "bench/analysis/run_index.h"

#include <map>
#include <string>

namespace boxwood::bench {

inline constexpr std::size_t least_sizes = 3; ///< fewer give no exponent

/// Time as a power of n. The exponent is the least-squares slope of log time over log n, fitted
/// round by round, then the median over the rounds that have every size; `off` the farthest factor
/// less 1 of the median times from the line through them.
struct Growth {
    MedianInterval exponent;
    double off = unknown;
};
Growth growth_of(const std::map<double, const RoundTimes::Rounds*>& times_by_n);

/// The exponents of build and query, and of update and a frame where there are, of all timed at
/// `least_sizes` sizes of one scene. Empty if nothing was.
std::string growth_text(const RunIndex& index);

} // namespace boxwood::bench
