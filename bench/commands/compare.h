#pragma once

#include "bench/analysis/comparisons.h"
#include "results/results.h"

#include <optional>
#include <string>

namespace boxwood::bench {

/// "5%" or "0.5 %" as 0.05 or 0.005. Throws BadInput for anything else.
double percent_of(const std::string& text);

/// The 0.05 of "slower>5%". Throws BadInput for anything else.
double fail_threshold(const std::string& condition);

/// The exit code of `boxwood compare`. Failed: a cell is newly wrong, or slower (by more than
/// fail_if, if given). Cannot tell: nothing failed, but such a slowdown (of delta without fail_if)
/// is not excluded by some interval, or a cell of the base is gone or has another scene.
int exit_code_of(const FileComparison& comparison, double delta, std::optional<double> fail_if);

/// The table and what is to be said about it.
std::string comparison_text(const results::Results& base, const results::Results& head,
                            const FileComparison& comparison, bool markdown);
std::string comparison_json(const FileComparison& comparison);

} // namespace boxwood::bench
