#pragma once

#include "results/results.h"

#include <string>

namespace boxwood::bench {

/// All of a result file, for the terminal: machines and file state, then for each scene, task and
/// number of threads the times, checks and work of its cells; every comparison; what was wrong or
/// unsupported. As the file has it: nothing is derived here.
std::string all_text(const results::Results& results);

/// One line for each phase of each cell, with a header.
std::string csv_text(const results::Results& results);

/// The derived tables, and the cells that they refer to, as one JSON object of lists.
std::string json_text(const results::Results& results);

/// The samples as google-benchmark's JSON, which its compare.py reads: a benchmark CELL/PHASE with
/// a repetition per round; what was answered wrong is an error there.
std::string google_benchmark_text(const results::Results& results);

} // namespace boxwood::bench
