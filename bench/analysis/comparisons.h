#pragma once

#include "bench/analysis/index.h"
#include "bench/analysis/times.h"
#include "results/results.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace boxwood::bench {

/// Every comparison within one file, cell b against cell a, for each phase that both have and for
/// the sums with the query. The claims of one line about one task are decided together:
/// - peers: each cell of ours against the peers of its class in its job (see job.h). Where one side
///   alone keeps a structure, the query of the other holds all the work: only the sum is compared.
///   On several threads a peer that they slow down, or that has none, stands with its cell on one,
///   if any peer has several there.
/// - ours: each cell of ours against the reference of its job (see reference_of).
/// - threads: several threads against one, of each contender.
/// - stages: all stages against only the required ones, and a scene with an effect against the same
///   without it.
/// - devices: our best on a device from end to end against our best of 1, of 2 and of the most
///   threads (see device_races), by the total of the task.
/// - errors: a contender whose answers may err, or are not certified, against itself without that.
/// Builders alone are compared unless the faster one's tree has a higher surface-area cost, by more
/// than 1 %: what a trade-off is worth, the front in /trees shows.
/// A wrong answer gets the verdict wrong and no ratio; what was not checked, cannot_tell.
/// Needs Cell::status.
std::vector<results::Comparison> comparisons_of(const results::Results& results, const Times& times,
                                                double delta);

/// The cell of ours that `judged` is held against: of the right ones of its job, executor,
/// precision and classes the reference builder with the same layout and kernel, else its first one
/// of the reference builder, else its first. Null if that is itself, or it is a kernel on hard
/// cases or a way to play a scene.
const results::Cell* reference_of(const Index& index, const results::Cell& judged);

/// Our best right cells of one scene, task and precision by the total of the task.
struct DeviceRace {
    results::Phase total = results::Phase::none;
    const results::Cell* device = nullptr;   ///< from the host's boxes to the host's answers
    const results::Cell* resident = nullptr; ///< null if there is none
    const results::Cell* graph = nullptr;    ///< so, by a CUDA graph
    /// By threads: of 1, of 2 and of the most, as far as they were timed in rounds of the device.
    std::map<std::uint32_t, const results::Cell*> processors;
    const results::Cell* fastest = nullptr; ///< of the processors
};
/// In the order of scenes and tasks. Needs Cell::status.
std::vector<DeviceRace> device_races(const Index& index, const Times& times);

/// The median of a cell in the rounds that it has in common with the other; NaN if there is none.
double shared_median(const Times& times, const results::Cell& cell, const results::Cell& other,
                     results::Phase phase);

/// The names in Cell::classes.
std::vector<std::string> split_classes(const std::string& classes);

void set_ruling(results::Comparison& row, const Ruling& ruling);

} // namespace boxwood::bench
