#pragma once

#include "results/results.h"

#include <vector>

namespace boxwood::bench {

/// Sets Sample::off_median of every sample. Needs /medians.
void set_off_medians(results::Results& results);

/// How far the queries of each round were off their cells' medians; the A/A twin left out. Needs
/// Sample::off_median.
std::vector<results::Drift> drift_of(const results::Results& results);

} // namespace boxwood::bench
