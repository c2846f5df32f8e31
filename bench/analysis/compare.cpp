#include "bench/analysis/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

namespace boxwood::bench {
namespace {

using results::Comparison;
using results::Results;
using results::Sample;

/// In a merged file a machine may have had the same round number several times.
using RoundKey = RoundTimes::RoundKey;
using Rounds = RoundTimes::Rounds;
/// The times of each (cell, phase).
using Times = std::map<std::pair<std::uint32_t, std::string>, Rounds>;

/// Machines outside `machines` are taken as one. Times that are missing or not positive are left
/// out.
Times times_of(const Results& results, const std::set<std::string>& machines, bool twins) {
    std::map<std::uint32_t, std::string> machine_of;
    for (const auto& env : results.env)
        machine_of[env.env_id] = machines.contains(env.env_hash) ? env.env_hash : "";
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

    Times times;
    for (const Sample* sample : samples) {
        const auto shard = shard_of.find(sample->shard_id);
        const std::string machine =
            shard == shard_of.end() ? "" : machine_of[shard->second->env_id];
        times[{sample->cell_id, sample->phase}][{machine, sample->round}].push_back(
            sample->wall_ns);
    }
    return times;
}

std::set<std::string> machines_of(const Results& results) {
    std::set<std::string> machines;
    for (const auto& env : results.env)
        machines.insert(env.env_hash);
    return machines;
}

/// combine(a, b) for every round that both have, the i-th of a round number with the i-th.
template <class Combine> void for_each_pair(const Rounds& a, const Rounds& b, Combine&& combine) {
    for (const auto& [key, left] : a)
        if (const auto right = b.find(key); right != b.end())
            for (std::size_t i = 0; i < std::min(left.size(), right->second.size()); ++i)
                combine(key, left[i], right->second[i]);
}

std::vector<double> log_ratios(const Rounds& a, const Rounds& b) {
    std::vector<double> logs;
    for_each_pair(a, b, [&](const RoundKey&, double ns_a, double ns_b) {
        logs.push_back(std::log(ns_b / ns_a));
    });
    return logs;
}

/// The phases of each cell, and what build or update takes together with the query.
std::map<std::uint32_t, std::map<std::string, Rounds>> phases_of(const Times& times) {
    std::map<std::uint32_t, std::map<std::string, Rounds>> phases;
    for (const auto& [key, rounds] : times)
        phases[key.first][key.second] = rounds;
    for (auto& [cell, rounds_of] : phases)
        for (const char* first : {"build", "update"}) {
            if (!rounds_of.contains(first) || !rounds_of.contains("query"))
                continue;
            Rounds sum;
            for_each_pair(rounds_of[first], rounds_of["query"],
                          [&](const RoundKey& key, double ns, double query_ns) {
                              sum[key].push_back(ns + query_ns);
                          });
            rounds_of[std::string(first) + "+query"] = std::move(sum);
        }
    return phases;
}

/// A comparison before its family is known.
struct Claim {
    Comparison* row;
    PairedRatio ratio;
};

/// Corrects the claims of one family and gives each its verdict.
void judge(std::span<const Claim> family, double delta, double floor) {
    std::vector<double> p;
    for (const Claim& claim : family)
        p.push_back(claim.ratio.p);
    const auto adjusted = holm(p);
    for (std::size_t i = 0; i < family.size(); ++i) {
        family[i].row->p_adj = adjusted[i];
        family[i].row->verdict = verdict(family[i].ratio, adjusted[i], delta, floor);
    }
}

Comparison comparison_of(std::uint32_t a, std::uint32_t b, const std::string& phase,
                         const PairedRatio& ratio) {
    return {a, b, phase, ratio.n_pairs, ratio.ratio, ratio.ci_lo, ratio.ci_hi, 1.0, "cannot_tell"};
}

Comparison wrong_comparison(std::uint32_t a, std::uint32_t b, const std::string& phase,
                            std::size_t n_pairs) {
    Comparison row;
    row.cell_a = a;
    row.cell_b = b;
    row.phase = phase;
    row.n_pairs = n_pairs;
    row.verdict = "wrong";
    return row;
}

} // namespace

std::vector<CellStats> cell_stats(const Results& results) {
    std::vector<CellStats> all;
    for (const auto& [key, rounds] : times_of(results, machines_of(results), false)) {
        std::vector<double> ns;
        for (const auto& [round, values] : rounds)
            ns.insert(ns.end(), values.begin(), values.end());
        std::ranges::sort(ns);
        CellStats stats{key.first, key.second, ns.size()};
        stats.median_ns = median_of_sorted(ns);
        stats.min_ns = ns.front();
        stats.p95_ns = percentile_of_sorted(ns, 0.95);
        stats.p99_ns = percentile_of_sorted(ns, 0.99);
        for (double& value : ns)
            value = std::abs(value - stats.median_ns);
        std::ranges::sort(ns);
        stats.mad_ns = median_of_sorted(ns);
        all.push_back(std::move(stats));
    }
    return all;
}

RoundTimes::RoundTimes(const Results& results)
    : phases_(phases_of(times_of(results, machines_of(results), false))) {}

const Rounds* RoundTimes::rounds(std::uint32_t cell, const std::string& phase) const {
    const auto phases = phases_.find(cell);
    if (phases == phases_.end())
        return nullptr;
    const auto found = phases->second.find(phase);
    return found == phases->second.end() ? nullptr : &found->second;
}

PairedRatio RoundTimes::ratio(std::uint32_t a, std::uint32_t b, const std::string& phase) const {
    const Rounds *left = rounds(a, phase), *right = rounds(b, phase);
    return left && right ? paired_ratio(log_ratios(*left, *right)) : PairedRatio{};
}

std::optional<double> noise_floor(const Results& results) {
    const auto machines = machines_of(results);
    const Times times = times_of(results, machines, false);
    std::optional<double> floor;
    for (const auto& [key, twin] : times_of(results, machines, true)) {
        const auto first = times.find(key);
        if (first == times.end())
            continue;
        const PairedRatio ratio = paired_ratio(log_ratios(first->second, twin));
        if (!std::isnan(ratio.ci_lo))
            floor = std::max({floor.value_or(0), ratio.ci_hi - 1, 1 / ratio.ci_lo - 1});
    }
    return floor;
}

std::map<std::uint32_t, Standing> standings(const Results& results) {
    std::map<std::uint32_t, Standing> all;
    for (const auto& cell : results.cells)
        all[cell.cell_id] = Standing::unchecked;
    constexpr std::array<std::string_view, 3> fine{"exact", "conservative", "within_bound"};
    for (const auto& check : results.checks) {
        Standing& standing = all[check.cell_id];
        if (check.status == "wrong")
            standing = Standing::wrong;
        else if (standing == Standing::unchecked && std::ranges::count(fine, check.status) > 0)
            standing = Standing::right;
    }
    for (const Sample& sample : results.samples)
        if (sample.flags & results::wrong_answer)
            all[sample.cell_id] = Standing::wrong;
    return all;
}

std::vector<Comparison> compare_to_peers(const Results& results, double delta) {
    std::set<std::uint32_t> peer_variants;
    for (const auto& variant : results.variants)
        if (variant.is_peer)
            peer_variants.insert(variant.variant_id);
    using Job = std::tuple<std::uint32_t, std::string, std::uint32_t>; // scene, ask, threads
    std::map<Job, std::vector<std::uint32_t>> peers_of;
    for (const auto& cell : results.cells)
        if (peer_variants.contains(cell.variant_id))
            peers_of[{cell.scene_id, cell.task, cell.threads}].push_back(cell.cell_id);

    const auto phases = phases_of(times_of(results, machines_of(results), false));
    auto standing_of = standings(results);
    const double floor = noise_floor(results).value_or(0);
    std::vector<Comparison> all;
    for (const auto& cell : results.cells) {
        const auto ours = phases.find(cell.cell_id);
        if (peer_variants.contains(cell.variant_id) || ours == phases.end())
            continue;
        for (const auto& [phase, rounds] : ours->second) {
            std::vector<Comparison> rows;
            std::vector<std::pair<std::size_t, PairedRatio>> claims;
            for (const std::uint32_t peer : peers_of[{cell.scene_id, cell.task, cell.threads}]) {
                const auto theirs = phases.find(peer);
                if (theirs == phases.end() || !theirs->second.contains(phase))
                    continue;
                const auto ratio = paired_ratio(log_ratios(theirs->second.at(phase), rounds));
                if (ratio.n_pairs == 0)
                    continue;
                const std::pair sides{standing_of[peer], standing_of[cell.cell_id]};
                if (sides.first == Standing::wrong || sides.second == Standing::wrong) {
                    rows.push_back(wrong_comparison(peer, cell.cell_id, phase, ratio.n_pairs));
                    continue;
                }
                if (sides == std::pair{Standing::right, Standing::right})
                    claims.emplace_back(rows.size(), ratio);
                rows.push_back(comparison_of(peer, cell.cell_id, phase, ratio));
            }
            std::vector<Claim> family;
            for (const auto& [row, ratio] : claims)
                family.push_back({&rows[row], ratio});
            judge(family, delta, floor);
            all.insert(all.end(), rows.begin(), rows.end());
        }
    }
    return all;
}

FileComparison compare_files(const Results& base, const Results& head, double delta) {
    FileComparison result;
    std::set<std::string> common;
    std::ranges::set_intersection(machines_of(base), machines_of(head),
                                  std::inserter(common, common.end()));
    result.is_same_machine = !common.empty();
    const auto floors = {noise_floor(base), noise_floor(head)};
    result.floor = std::max(floors); // an absent one is less than any

    struct Timed {
        std::uint32_t cell_id;
        std::uint64_t content;
        const std::map<std::string, Rounds>* phases;
    };
    const auto timed_by_name = [](const Results& results, const auto& phases) {
        std::map<std::uint32_t, std::uint64_t> content_of;
        for (const auto& scene : results.scenes)
            content_of[scene.scene_id] = scene.content_hash;
        std::multimap<std::string, Timed> timed;
        for (const auto& cell : results.cells)
            if (const auto found = phases.find(cell.cell_id); found != phases.end())
                timed.emplace(cell.name,
                              Timed{cell.cell_id, content_of[cell.scene_id], &found->second});
        return timed;
    };
    const auto base_phases = phases_of(times_of(base, common, false));
    const auto head_phases = phases_of(times_of(head, common, false));
    const auto in_base = timed_by_name(base, base_phases);
    auto in_head = timed_by_name(head, head_phases);
    auto base_standing = standings(base), head_standing = standings(head);

    std::vector<std::pair<std::size_t, PairedRatio>> claims;
    for (const auto& [name, a] : in_base) {
        const auto match = in_head.find(name); // equal names of a merged file match in order
        if (match == in_head.end()) {
            result.only_base.push_back(name);
            // Not timed any more because it throws or crashes: not merely left out.
            for (const auto& cell : head.cells)
                if (cell.name == name && head_standing[cell.cell_id] == Standing::wrong)
                    result.rows.push_back({name,
                                           wrong_comparison(a.cell_id, cell.cell_id, "query", 0),
                                           base_standing[a.cell_id] != Standing::wrong});
            continue;
        }
        const Timed b = match->second;
        in_head.erase(match);
        if (a.content != b.content) {
            result.other_content.push_back(name);
            continue;
        }
        const bool was_wrong = base_standing[a.cell_id] == Standing::wrong;
        const bool is_wrong = head_standing[b.cell_id] == Standing::wrong;
        for (const auto& [phase, rounds] : *a.phases) {
            const auto other = b.phases->find(phase);
            if (phase.find('+') != std::string::npos || other == b.phases->end())
                continue;
            const auto ratio = paired_ratio(log_ratios(rounds, other->second));
            if (was_wrong || is_wrong) {
                result.rows.push_back({name,
                                       wrong_comparison(a.cell_id, b.cell_id, phase, ratio.n_pairs),
                                       is_wrong && !was_wrong});
                continue;
            }
            claims.emplace_back(result.rows.size(), ratio);
            result.rows.push_back({name, comparison_of(a.cell_id, b.cell_id, phase, ratio)});
        }
    }
    for (const auto& [name, timed] : in_head)
        result.only_head.push_back(name);
    result.family_size = claims.size();
    std::vector<Claim> family;
    for (const auto& [row, ratio] : claims)
        family.push_back({&result.rows[row].comparison, ratio});
    judge(family, delta, result.floor.value_or(0));
    return result;
}

} // namespace boxwood::bench
