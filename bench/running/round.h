#pragma once

#include "bench/io/progress.h"
#include "bench/plan/plan.h"
#include "bench/running/cold.h"
#include "results/results.h"

#include <functional>

namespace boxwood::bench {

/// Times every calibrated cell of the plan once, in the shuffled order of this round, and the A/A
/// cell twice. Gives a shard that stands for itself: the rows of `prepared` that samples refer to,
/// one shard row, and a sample per cell and phase (build, query; or build; or query; or build,
/// update, query with a row per frame, and one per stage where a contender has stages). An answer
/// that differs from the checked one marks the sample `wrong_answer`. What a contender throws comes
/// out. Cold times come first, by `cold`, if it is given.
results::Results run_round(const Plan& plan, const results::Results& prepared, unsigned round,
                           const Report& report,
                           const std::function<ColdTimes(const std::string& cell)>& cold = {});

} // namespace boxwood::bench
