#pragma once

#include "bench/tasks/task.h"
#include "scenes/hard_cases/hard_cases.h"

#include <string_view>
#include <vector>

/// Families of hard cases as the scenes of tasks.
namespace boxwood::bench {

/// The kind of a family's cases, shown by a few of them. Nothing for a family that reads files.
const Cases& sample_of(const HardCaseFamily& family);

/// The families that a name stands for and that have cases for the task, in the order of the
/// registry. Those that read files are left out.
std::vector<const HardCaseFamily*> families_of(std::string_view name, const Task& task);

} // namespace boxwood::bench
