#pragma once

#include "bench/analysis/comparisons.h"
#include "results/results.h"

#include <string>

namespace boxwood::bench {

/// "5%" or "0.5 %" as 0.05 or 0.005. Throws BadInput for anything else.
double percent_of(const std::string& text);

/// The 0.05 of "slower>5%". Throws BadInput for anything else.
double fail_threshold(const std::string& condition);

/// The exit code of `boxwood compare`.
int exit_code_of(Gate gate);

/// One line with the verdict, the table, and what is to be said about it.
std::string comparison_text(const results::Results& base, const results::Results& head,
                            const FileComparison& comparison, const FileOptions& options,
                            bool markdown);
std::string comparison_json(const FileComparison& comparison);

} // namespace boxwood::bench
