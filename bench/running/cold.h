#pragma once

#include "bench/plan/plan.h"

#include <cstdint>
#include <string>

namespace boxwood::bench {

/// A first build, and with it a first query, in a process that did neither before: no memory of an
/// earlier one is there to be used again.
struct ColdTimes {
    double build_ns = 0, build_and_query_ns = 0;
    std::uint64_t hash = 0; ///< of the answers
};

/// To be called once in a process.
ColdTimes time_cold(const PlannedCell& cell, const SceneSpec& spec);

/// A line, and what it says. Throws std::runtime_error if it is not such a line.
std::string to_text(const ColdTimes& times);
ColdTimes cold_times_of(const std::string& line);

/// Runs this process's command again with `--cold CELL`. Throws std::runtime_error if that fails.
ColdTimes run_cold_process(const std::string& cell);

} // namespace boxwood::bench
