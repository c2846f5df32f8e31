#include "bench/analysis/size_scaling.h"

#include "bench/analysis/status.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Cell;
using Rounds = Times::Rounds;

/// A round's first time; a merged file may have several of one number.
double first_ns(const Rounds& rounds, const Times::RoundKey& key) { return rounds.at(key).front(); }

} // namespace

PowerOfN power_of_n(const std::map<double, const Rounds*>& times_by_n) {
    std::vector<double> log_n, log_median, slopes;
    for (const auto& [n, rounds] : times_by_n) {
        log_n.push_back(std::log(n));
        std::vector<double> ns;
        for (const auto& [key, values] : *rounds)
            ns.insert(ns.end(), values.begin(), values.end());
        log_median.push_back(std::log(median_interval(std::move(ns)).mid));
    }
    for (const auto& [key, values] : *times_by_n.begin()->second) {
        std::vector<double> log_ns;
        for (const auto& [n, rounds] : times_by_n)
            if (rounds->contains(key))
                log_ns.push_back(std::log(first_ns(*rounds, key)));
        if (log_ns.size() == log_n.size())
            slopes.push_back(fitted_line(log_n, log_ns).slope);
    }
    PowerOfN power{median_interval(std::move(slopes)), 0};
    const Line line = fitted_line(log_n, log_median);
    for (std::size_t i = 0; i < log_n.size(); ++i)
        power.off_line =
            std::max(power.off_line,
                     std::expm1(std::abs(log_median[i] - line.at_0 - line.slope * log_n[i])));
    return power;
}

std::vector<results::SizeScaling> size_scaling_of(const results::Results& results,
                                                  const Times& times) {
    std::map<std::uint32_t, const results::SceneRow*> scenes;
    for (const results::SceneRow& scene : results.scenes)
        scenes[scene.scene_id] = &scene;
    // Scene and seed, task, threads, variant, executor, precision; then the cell of each size.
    using Key = std::tuple<std::string, std::uint64_t, std::string, std::uint32_t, std::uint32_t,
                           std::string, std::string>;
    std::map<Key, std::map<double, const Cell*>> lines;
    for (const Cell& cell : results.cells)
        if (is_right(cell.status) && scenes.contains(cell.scene_id))
            lines[{scenes[cell.scene_id]->name, scenes[cell.scene_id]->seed, cell.task,
                   cell.threads, cell.variant_id, cell.executor, cell.precision}]
                 [static_cast<double>(cell.n_items)] = &cell;
    std::vector<results::SizeScaling> all;
    for (const auto& [key, line] : lines) {
        std::map<results::Phase, std::map<double, const Rounds*>> by_phase;
        for (const auto& [n, cell] : line)
            if (const auto timed = times.by_cell().find(cell->cell_id);
                timed != times.by_cell().end())
                for (const auto& [phase, rounds] : timed->second)
                    by_phase[phase][n] = &rounds;
        for (const auto& [phase, by_n] : by_phase) {
            if (by_n.size() < min_sizes)
                continue;
            const PowerOfN power = power_of_n(by_n);
            all.push_back({line.at(by_n.rbegin()->first)->cell_id, phase, by_n.size(),
                           power.exponent.mid, power.exponent.lo, power.exponent.hi,
                           power.off_line});
        }
    }
    return all;
}

} // namespace boxwood::bench
