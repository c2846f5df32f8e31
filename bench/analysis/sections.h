#pragma once

#include "results/results.h"

#include <span>
#include <string>

namespace boxwood::bench {

/// What the cells of a result file come to, each table under a line that says how to read it: the
/// best of each library, trees, trees for rays, threads, frames, policies, the effects ledger, what
/// effects cost, growth with n. In brief the frames of the best alone.
std::string sections_text(const results::Results& results,
                          std::span<const results::Comparison> comparisons, bool brief);

} // namespace boxwood::bench
