#pragma once

#include "results/results.h"

#include <string>
#include <vector>

namespace boxwood::bench {

/// What each kernel costs and how often it is wrong, over all families of hard cases of a panel:
/// ours before peers, by rising time. A kernel's time is the sweep's median where there is one,
/// else the check's own. Whole queries and unsupported rows are left out. Needs /medians.
std::vector<results::KernelCost> kernel_costs_of(const results::Results& results);

/// The same as a table; empty without rows.
std::string kernel_costs_text(const results::Results& results);

} // namespace boxwood::bench
