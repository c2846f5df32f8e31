#pragma once

#include "bench/analysis/statistics.h"
#include "results/results.h"

#include <span>

namespace boxwood::bench {

/// Fills every derived table and column of a file that is about to be written: statuses, medians,
/// comparisons with their verdicts, scaling, trade-offs, kernels, frames, stages, findings, health,
/// and whatever else is drawn. Nobody else derives them: readers take what the file says. What was
/// derived before is replaced.
void analyse(results::Results& results, double delta = default_delta);

/// The delta with which the first of the parts was analysed, else the default.
double delta_of(std::span<const results::Results> parts);

} // namespace boxwood::bench
