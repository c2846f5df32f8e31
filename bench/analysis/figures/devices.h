#pragma once

#include "bench/analysis/times.h"
#include "results/results.h"

namespace boxwood::bench {

/// Fills /device_gains, by task and scene with growing sizes, and /device_break_even from it. Needs
/// Cell::status, /medians and /compare.
void set_device_gains(results::Results& results, const Times& times);

} // namespace boxwood::bench
