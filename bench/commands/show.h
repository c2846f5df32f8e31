#pragma once

#include "results/results.h"

#include <string>

namespace boxwood::bench {

/// What is in a result file, for the terminal: machines and file state, then for each scene, ask
/// and number of threads the times, checks, work and verdicts of its cells, and what was wrong or
/// unsupported; last what they come to (see sections.h), which is all of it if `brief`. Verdicts
/// are made again from the samples.
std::string show_text(const results::Results& results, bool with_kernels = false,
                      bool brief = false);

} // namespace boxwood::bench
