#pragma once

#include "results/results.h"

#include <vector>

namespace boxwood::bench {

/// The stages of each cell that plays a scene, in the order of its plan: the median over the rounds
/// of each, divided by the frames. A stage that was never called costs nothing.
std::vector<results::StageCost> stage_costs_of(const results::Results& results);

/// What each effect of a played scene costs, and all stages beyond those that it requires: the
/// paired ratios of /compare with what they are worth in time. Wrong answers are left out.
/// Needs /compare and /medians.
std::vector<results::EffectCost> effect_costs_of(const results::Results& results);

} // namespace boxwood::bench
