#pragma once

#include "results/results.h"

#include <span>
#include <string>

namespace boxwood::bench {

/// What the cells of a result file come to, each table under a line that says how to read it: the
/// best of each library, trees, trees for rays, threads, the policy auto, growth with n.
std::string sections_text(const results::Results& results,
                          std::span<const results::Comparison> comparisons);

} // namespace boxwood::bench
