#pragma once

#include "results/results.h"

#include <string_view>
#include <vector>

/// What is said of kernels on hard cases, family by family.
namespace boxwood::bench {

/// A family that is none: its rows are of whole queries.
inline constexpr std::string_view whole_queries = "typical";

/// Whether the row is of a kernel that answered hard cases.
bool is_judged(const results::KernelRow& row);

/// Sets the label, time and rates of every row of /kernels. A kernel's time is the sweep's median
/// where there is one, else the check's own. Needs /medians.
void set_kernel_rows(results::Results& results);

/// The worst errors of each kernel by decade of the condition. Needs KernelRow::label.
std::vector<results::KernelCondition> kernel_conditions_of(const results::Results& results);

/// How far up its tiers each kernel of ours went that decided some calls of a family by tier 0 and
/// others not: by family, then over all of them. Needs KernelRow::label.
std::vector<results::Escalation> escalations_of(const results::Results& results);

} // namespace boxwood::bench
