#pragma once

#include "bench/io/progress.h"
#include "bench/plan/plan.h"
#include "results/results.h"

#include <set>
#include <string>

namespace boxwood::bench {

/// What all rounds of a sweep share, found out once: scenes, variants, cells; each cell checked
/// against the truth (the hash of its answer in the check); work counters, tree quality; and the
/// iterations of each phase as /text/calibration (see calibration.h). No shards and no samples.
/// A cell that is unsupported or throws gets a check that says so and no calibration. Cells in
/// `skip` are not run at all: they get neither.
results::Results prepare(const Plan& plan, const results::Env& env,
                         const std::set<std::string>& skip, const Report& report);

/// Takes a cell that brought the process down out of the sweep: its check becomes `wrong` with this
/// witness, and it is not timed any more. False if it is out already.
bool mark_crashed(results::Results& prepared, const std::string& cell, const std::string& witness);

} // namespace boxwood::bench
