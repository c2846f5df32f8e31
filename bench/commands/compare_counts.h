#pragma once

#include "bench/analysis/counts/compare_counts.h"
#include "bench/commands/compare.h"
#include "results/results.h"

#include <string>

namespace boxwood::bench {

/// What `boxwood compare --count` prints: one line with the verdict, what is lost, and the table of
/// what changed, or of all.
std::string counts_text(const results::Results& base, const results::Results& head,
                        const CountComparison& comparison, const CountOptions& options,
                        const FileView& view = {});
std::string counts_json(const CountComparison& comparison);

} // namespace boxwood::bench
