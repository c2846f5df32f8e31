#pragma once

#include "bench/plan/plan.h"
#include "results/results.h"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace boxwood::bench {

struct SweepOptions {
    std::filesystem::path config, out;
    Overrides overrides;
    unsigned shard = 0, shards = 1; ///< only the rounds with round % shards == shard
    /// If above 0, the time for all rounds: no more than 9 rounds where there is no more time, and
    /// more than planned while comparisons with peers are open.
    double budget_s = 0;
    /// How long rounds wait in all for a quiet machine; and no longer than they take.
    double wait_s = 60;
    double give_up_s = 600;   ///< a cell that says nothing for so long is left out
    bool counts = false;      ///< instructions of our cells instead of rounds: see count.h
    std::string command_line; ///< recorded
    bool is_quiet = false;    ///< the findings are not printed
    bool goes_on = true;      ///< the same command, given again, takes up what is there
};

/// Prints the cells of a sweep and how long it may take; if it counts, those that are counted.
void list_cells(const SweepOptions& options);

/// Plans, prepares, runs every round in a process of its own, merges, compares and prints the
/// findings. Rounds that are already there, in OUT or beside it, are not run again. Gives an exit
/// code; throws BadInput for bad input and for a place that takes no data.
int run_sweep(const SweepOptions& options);

/// Where sweep_in_turns puts the results of the other program: FILE.base.h5 beside FILE.h5.
std::filesystem::path base_file_of(const std::filesystem::path& out);

/// The rounds of this program and of another one take turns, so that what the machine does meets
/// both alike. Both are ordinary sweeps, which go on where they were interrupted. False if they
/// were; throws BadInput if a program cannot do the sweep.
bool sweep_in_turns(const std::filesystem::path& program, const SweepOptions& options);

/// What one child process does: the preparation, one round, or the count of instructions.
struct ChildOptions {
    std::filesystem::path config, prepared, out, dumps; ///< dumps: of callgrind, if it counts
    Overrides overrides;
    std::string sweep_hash; ///< that of the parent's plan
    bool is_preparation = false;
    unsigned round = 0;
    double other_cores = results::missing; ///< processors at work for others before the round
    std::string cold;           ///< the one cell whose first build is timed, nothing else
    std::set<std::string> skip; ///< cells that the preparation leaves out
    int report_fd = -1;
};

/// Gives an exit code; what goes wrong is reported to the parent.
int run_sweep_child(const ChildOptions& options);

} // namespace boxwood::bench
