#include "bench/analysis/times.h"

#include "bench/analysis/limits.h"

#include <algorithm>
#include <cmath>

namespace boxwood::bench {
namespace {

using results::Phase;
using results::Results;
using results::Sample;
using Rounds = Times::Rounds;
using ByCell = std::map<std::uint32_t, Times::Phases>;

/// By env_id; of those outside `machines` nothing.
std::map<std::uint32_t, std::string> names_of(const Results& results,
                                              const std::set<std::string>& machines) {
    std::map<std::uint32_t, std::string> names;
    for (const auto& env : results.env)
        names[env.env_id] = machines.contains(env.env_hash) ? env.env_hash : "";
    return names;
}

/// Times that are missing or not positive are left out.
ByCell times_of(const Results& results, const std::set<std::string>& machines, bool twins) {
    std::map<std::uint32_t, std::string> machine_of = names_of(results, machines);
    std::map<std::uint32_t, const results::Shard*> shard_of;
    for (const auto& shard : results.shards)
        shard_of[shard.shard_id] = &shard;

    std::vector<const Sample*> samples;
    for (const Sample& sample : results.samples)
        if (sample.wall_ns > 0 && std::isfinite(sample.wall_ns) &&
            ((sample.flags & results::aa_twin) != 0) == twins)
            samples.push_back(&sample);
    const auto start_of = [&](const Sample* sample) {
        const auto shard = shard_of.find(sample->shard_id);
        return shard == shard_of.end() ? std::uint64_t{0} : shard->second->t0_utc_ns;
    };
    std::ranges::stable_sort(samples, {}, start_of);

    ByCell times;
    for (const Sample* sample : samples) {
        const auto shard = shard_of.find(sample->shard_id);
        const std::string machine =
            shard == shard_of.end() ? "" : machine_of[shard->second->env_id];
        times[sample->cell_id][sample->phase][{machine, sample->round}].push_back(sample->wall_ns);
    }
    return times;
}

/// combine(a, b) for every round that both have, the i-th of a round number with the i-th.
template <class Combine> void for_each_pair(const Rounds& a, const Rounds& b, Combine&& combine) {
    for (const auto& [key, left] : a)
        if (const auto right = b.find(key); right != b.end())
            for (std::size_t i = 0; i < std::min(left.size(), right->second.size()); ++i)
                combine(key, left[i], right->second[i]);
}

} // namespace

std::vector<double> log_ratios(const Rounds& a, const Rounds& b) {
    std::vector<double> logs;
    for_each_pair(a, b, [&](const Times::RoundKey&, double ns_a, double ns_b) {
        logs.push_back(std::log(ns_b / ns_a));
    });
    return logs;
}

std::pair<double, double> paired_medians(const Rounds& a, const Rounds& b) {
    std::vector<double> of_a, of_b;
    for_each_pair(a, b, [&](const Times::RoundKey&, double ns_a, double ns_b) {
        of_a.push_back(ns_a);
        of_b.push_back(ns_b);
    });
    return {median_interval(std::move(of_a)).mid, median_interval(std::move(of_b)).mid};
}

std::set<std::string> machines_of(const Results& results) {
    std::set<std::string> machines;
    for (const auto& env : results.env)
        machines.insert(env.env_hash);
    return machines;
}

Times::Times(const Results& results) : Times(results, machines_of(results)) {}

Times::Times(const Results& results, const std::set<std::string>& machines)
    : cells_(times_of(results, machines, false)) {
    std::map<std::uint32_t, std::string> machine_of = names_of(results, machines);
    for (const results::Shard& shard : results.shards)
        input_of_[{machine_of[shard.env_id], shard.round}] = shard.input;
    for (auto& [cell, phases] : cells_)
        for (const auto& [first, both] : {std::pair{Phase::build, Phase::build_and_query},
                                          std::pair{Phase::update, Phase::update_and_query}}) {
            if (!phases.contains(first) || !phases.contains(Phase::query))
                continue;
            Rounds sum;
            for_each_pair(phases[first], phases[Phase::query],
                          [&](const RoundKey& key, double ns, double query_ns) {
                              sum[key].push_back(ns + query_ns);
                          });
            phases[both] = std::move(sum);
        }
}

const Rounds* Times::rounds(std::uint32_t cell, Phase phase) const {
    const auto phases = cells_.find(cell);
    if (phases == cells_.end())
        return nullptr;
    const auto found = phases->second.find(phase);
    return found == phases->second.end() ? nullptr : &found->second;
}

std::vector<double> Times::log_ratios(std::uint32_t a, std::uint32_t b, Phase phase) const {
    const Rounds *left = rounds(a, phase), *right = rounds(b, phase);
    return left && right ? bench::log_ratios(*left, *right) : std::vector<double>{};
}

std::vector<std::uint32_t> Times::inputs(std::uint32_t a, std::uint32_t b, Phase phase) const {
    std::vector<std::uint32_t> inputs;
    if (const Rounds* left = rounds(a, phase), *right = rounds(b, phase); left && right)
        for_each_pair(*left, *right, [&](const RoundKey& key, double, double) {
            const auto input = input_of_.find(key);
            inputs.push_back(input == input_of_.end() ? 0 : input->second);
        });
    return inputs;
}

std::vector<double> medians_by_round(const Rounds& rounds) {
    std::vector<double> all;
    for (auto [key, values] : rounds) {
        std::ranges::sort(values);
        all.push_back(median_of_sorted(values));
    }
    return all;
}

NoiseFloors::NoiseFloors(const Results& results, const Times& times) : times_(times) {
    std::map<std::uint32_t, const results::Cell*> cells;
    for (const results::Cell& cell : results.cells)
        cells[cell.cell_id] = &cell;
    std::map<Likeness, std::vector<double>> farthest; // ends of intervals
    for (const auto& [id, phases] : times_of(results, machines_of(results), true))
        for (const auto& [phase, twin] : phases) {
            const Rounds* const first = times.rounds(id, phase);
            if (!first || !cells.contains(id))
                continue;
            const PairedRatio ratio = paired_ratio(log_ratios(*first, twin));
            if (std::isnan(ratio.ci_lo))
                continue;
            const Likeness alike = likeness(*cells.at(id), phase);
            farthest[alike].push_back(std::max(ratio.ci_hi - 1, 1 / ratio.ci_lo - 1));
            floors_[alike] = std::max({floors_[alike], ratio.ratio - 1, 1 / ratio.ratio - 1});
        }
    for (auto& [alike, floor] : floors_) {
        std::vector<double>& ends = farthest.at(alike);
        std::ranges::sort(ends);
        floor = std::max(floor, ends[ends.size() / 2]);
    }
}

NoiseFloors::Likeness NoiseFloors::likeness(const results::Cell& cell, Phase phase) const {
    constexpr double brief_ns = 1e6;
    const Rounds* const rounds = times_.rounds(cell.cell_id, phase);
    return {cell.threads > 1, rounds && paired_medians(*rounds, *rounds).first < brief_ns,
            phase == Phase::cold_build || phase == Phase::cold_build_and_query ||
                phase == Phase::cold_query,
            phase == Phase::query || phase == Phase::cold_query || phase == Phase::device_query};
}

std::optional<double> NoiseFloors::of(const results::Cell& cell, Phase phase) const {
    const Likeness alike = likeness(cell, phase);
    const auto found = floors_.find(alike);
    const std::optional<double> as_one = found != floors_.end() ? std::optional(found->second)
                                         : alike.is_cold && highest(true) ? highest(true)
                                                                          : highest();
    if (phase == Phase::build_and_query)
        return std::max({as_one, of(cell, Phase::build), of(cell, Phase::query)});
    if (phase == Phase::update_and_query)
        return std::max({as_one, of(cell, Phase::update), of(cell, Phase::query)});
    return as_one;
}

std::optional<double> NoiseFloors::highest(bool cold) const {
    std::optional<double> floor;
    for (const auto& [likeness, of_these] : floors_)
        if (likeness.is_cold == cold)
            floor = std::max(floor, std::optional(of_these));
    return floor;
}

std::optional<double> NoiseFloors::lowest() const {
    std::optional<double> floor;
    for (const auto& [likeness, of_these] : floors_)
        if (!likeness.is_cold)
            floor = std::min(floor.value_or(of_these), of_these);
    return floor;
}

std::vector<results::Median> medians_of(const Results& results, const Times& times) {
    std::vector<results::Median> all;
    for (const results::Cell& cell : results.cells) {
        const auto timed = times.by_cell().find(cell.cell_id);
        if (timed == times.by_cell().end())
            continue;
        for (const auto& [phase, rounds] : timed->second) {
            std::vector<double> ns;
            for (const auto& [round, values] : rounds)
                ns.insert(ns.end(), values.begin(), values.end());
            if (ns.empty())
                continue;
            std::ranges::sort(ns);
            results::Median row{cell.cell_id, phase, ns.size()};
            row.median_ns = median_of_sorted(ns);
            row.min_ns = ns.front();
            row.p95_ns = percentile_of_sorted(ns, 0.95);
            row.p99_ns = percentile_of_sorted(ns, 0.99);
            for (double& value : ns)
                value = std::abs(value - row.median_ns);
            std::ranges::sort(ns);
            row.mad_ns = median_of_sorted(ns);
            row.limit_ns = limit_ns(results, cell, phase);
            row.times_limit = row.median_ns / row.limit_ns;
            all.push_back(row);
        }
    }
    return all;
}

} // namespace boxwood::bench
