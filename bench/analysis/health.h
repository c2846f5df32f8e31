#pragma once

#include "bench/analysis/times.h"
#include "results/results.h"

namespace boxwood::bench {

/// Whether a run can be believed, in numbers and in words. Needs Cell::status and
/// KernelRow::is_broken.
results::Health health_of(const results::Results& results, const NoiseFloors& floors, double delta);

} // namespace boxwood::bench
