#pragma once

#include "bench/io/progress.h"
#include "bench/plan/plan.h"
#include "results/results.h"

#include <filesystem>
#include <string>
#include <vector>

/// Instructions instead of times: they are the same in every run, whatever else the machine does.
namespace boxwood::bench {

/// Whether the instructions of a cell are counted: ours, on one thread of the processor.
bool is_counted(const PlannedCell& cell);

/// The command line that runs this program under `valgrind --tool=callgrind`, to be followed by
/// arguments of its own. What it counts goes to files `dumps`.1, `dumps`.2, ... Throws BadInput,
/// saying what to do, where this program cannot be run so.
std::vector<std::string> under_callgrind(const std::filesystem::path& dumps);

/// To be called in a process that runs under callgrind: gives what was prepared with the
/// instructions of each calibrated cell as counters, `instructions_build` and
/// `instructions_query` of the second call of each, or `instructions_frames` of the second pass
/// through all frames, updates and queries together, without those of malloc and free, which depend
/// on what other cells left; and in /text/instructions_by what else they depend on. Cells of an
/// instruction set that callgrind has not get none. What a contender throws comes out.
results::Results count_instructions(const Plan& plan, results::Results prepared,
                                    const std::filesystem::path& dumps, const Report& report);

} // namespace boxwood::bench
