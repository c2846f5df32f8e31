#pragma once

#include "bench/tasks/contender.h"
#include "scenes/hard_cases/hard_cases.h"

#include <string_view>
#include <vector>

/// Hard-case families as the scenes of kernel asks.
namespace boxwood::bench {

/// The kind of a family's cases, shown by a few of them. Nothing for a family that reads files.
const Cases& sample_of(const HardCaseFamily& family);

/// What the scene key of a sweep file may say for kernel asks: families, "all", and the panels.
std::vector<std::string_view> family_words();
/// Whether a word stands for several families.
bool is_group(std::string_view word);

/// The families that a word stands for and that have cases for the ask, in the order of the
/// registry. Those that read files are left out.
std::vector<const HardCaseFamily*> families_of(std::string_view word, Ask ask);

} // namespace boxwood::bench
