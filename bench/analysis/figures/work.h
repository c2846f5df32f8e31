#pragma once

#include "results/results.h"

#include <vector>

namespace boxwood::bench {

/// What a kernel of ours costs in a whole query: of cells of one job that differ by their kernel
/// alone, the time of each over that of the fastest, right or wrong. Needs /medians.
std::vector<results::QueryKernel> query_kernels_of(const results::Results& results);

/// Counts and time of one query of each cell whose work was counted, divided by its rays or points,
/// or else its items. Needs /medians.
std::vector<results::WorkRow> work_of(const results::Results& results);

} // namespace boxwood::bench
