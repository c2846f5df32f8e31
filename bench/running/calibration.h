#pragma once

#include "bench/plan/plan.h"
#include "results/results.h"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace boxwood::bench {

/// What the preparation found out about the time of one cell.
struct Calibration {
    std::uint64_t build_iterations = 1, query_iterations = 1; ///< per sample
    double build_ns = 0, query_ns = 0;                        ///< of one iteration
    bool operator==(const Calibration&) const = default;
};

/// By cell name. A cell that is not in it is not timed: it is unsupported, threw, or crashed.
using Calibrations = std::map<std::string, Calibration, std::less<>>;

/// How often to repeat a phase of `ns` so that a sample takes `target_ns`: at least once, at most
/// 10^7 times.
std::uint64_t iterations_for(double target_ns, double ns);

/// Expected time of the loops of a cell in one round: each phase once to warm up and then as
/// calibrated.
double round_ns(const Calibration& calibration);
/// Of the whole cell, seconds.
double cell_s(const PlannedCell& cell, const Calibration& calibration);
/// Before anything was measured: a microsecond per item, ray, point and region for each phase.
double guessed_cell_s(const PlannedCell& cell, double min_time_ms);

/// As the table that /text/calibration holds, and back. Throws std::runtime_error for other text.
std::string to_text(const Calibrations& calibrations);
Calibrations calibrations_of(std::string_view text);

/// The A/A cells, which each round times twice: of each kind (ours on one thread or on several,
/// with a query below a millisecond or not, with queries after a flush of the caches; peers) the
/// right one that takes the least time, if it takes more than a tenth of the time of the round only
/// where there is no other twin; one of `in_fewer_rounds` only where its kind has no other. And of
/// each kind those in the places a quarter and a half up its order by time, the quickest first,
/// while all of these take less than a tenth of the round: one cell alone may lie well or badly in
/// memory.
std::set<std::string> choose_twins(const results::Results& prepared,
                                   const Calibrations& calibrations,
                                   const std::set<std::string>& in_fewer_rounds = {},
                                   const std::set<std::string>& with_cold_caches = {});

} // namespace boxwood::bench
