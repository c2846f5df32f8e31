#include "bench/analysis/comparisons.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace boxwood::bench {
namespace {

using results::Comparison;
using results::Phase;
using results::Results;
using results::Status;
using results::Verdict;

Comparison row_of(std::uint32_t a, std::uint32_t b, Phase phase) {
    Comparison row;
    row.cell_a = a;
    row.cell_b = b;
    row.phase = phase;
    return row;
}

Comparison wrong_row(std::uint32_t a, std::uint32_t b, Phase phase, std::size_t n_pairs) {
    Comparison row = row_of(a, b, phase);
    row.n_pairs = n_pairs;
    row.verdict = Verdict::wrong;
    return row;
}

} // namespace

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
        Status status;
        const Times::Phases* phases;
    };
    const auto timed_by_name = [](const Results& results, const auto& phases) {
        std::map<std::uint32_t, std::uint64_t> content_of;
        for (const auto& scene : results.scenes)
            content_of[scene.scene_id] = scene.content_hash;
        std::multimap<std::string, Timed> timed;
        for (const auto& cell : results.cells)
            if (const auto found = phases.find(cell.cell_id); found != phases.end())
                timed.emplace(cell.name, Timed{cell.cell_id, content_of[cell.scene_id], cell.status,
                                               &found->second});
        return timed;
    };
    const Times base_times(base, common), head_times(head, common);
    const auto in_base = timed_by_name(base, base_times.by_cell());
    auto in_head = timed_by_name(head, head_times.by_cell());

    std::vector<std::size_t> claims; // rows
    std::vector<std::vector<double>> logs;
    for (const auto& [name, a] : in_base) {
        const auto match = in_head.find(name); // equal names of a merged file match in order
        if (match == in_head.end()) {
            result.only_base.push_back(name);
            // Not timed any more because it throws or crashes: not merely left out.
            for (const auto& cell : head.cells)
                if (cell.name == name && cell.status == Status::wrong)
                    result.rows.push_back({name,
                                           wrong_row(a.cell_id, cell.cell_id, Phase::query, 0),
                                           a.status != Status::wrong});
            continue;
        }
        const Timed b = match->second;
        in_head.erase(match);
        if (a.content != b.content) {
            result.other_content.push_back(name);
            continue;
        }
        const bool was_wrong = a.status == Status::wrong, is_wrong = b.status == Status::wrong;
        for (const auto& [phase, rounds] : *a.phases) {
            const auto other = b.phases->find(phase);
            if (phase == Phase::build_and_query || phase == Phase::update_and_query ||
                other == b.phases->end())
                continue;
            std::vector<double> ratios = log_ratios(rounds, other->second);
            if (was_wrong || is_wrong) {
                result.rows.push_back({name, wrong_row(a.cell_id, b.cell_id, phase, ratios.size()),
                                       is_wrong && !was_wrong});
                continue;
            }
            claims.push_back(result.rows.size());
            result.rows.push_back(
                {name, row_of(a.cell_id, b.cell_id, phase), false, paired_ratio(ratios).ci_hi});
            logs.push_back(std::move(ratios));
        }
    }
    for (const auto& [name, timed] : in_head)
        result.only_head.push_back(name);
    result.family_size = claims.size();
    const auto decisions = decide(logs, delta, result.floor.value_or(0));
    for (std::size_t i = 0; i < claims.size(); ++i)
        set_decision(result.rows[claims[i]].comparison, decisions[i]);
    return result;
}

} // namespace boxwood::bench
