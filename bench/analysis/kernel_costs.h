#pragma once

#include "results/results.h"

#include <string>
#include <vector>

namespace boxwood::bench {

/// What each kernel costs and how often it is wrong, over all families of hard cases of a panel:
/// ours before peers, by rising time; the panels in the order of `all_panels`. Whole queries and
/// unsupported rows are left out. Tasks whose errors are known by condition are judged by these.
/// Needs what set_kernel_rows sets.
std::vector<results::KernelCost> kernel_costs_of(const results::Results& results);

/// The same as a table; empty without rows.
std::string kernel_costs_text(const results::Results& results);

} // namespace boxwood::bench
