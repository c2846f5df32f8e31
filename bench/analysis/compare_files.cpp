#include "bench/analysis/comparisons.h"
#include "bench/analysis/wording.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Comparison;
using results::Phase;
using results::Reason;
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

/// Newly wrong if it was right.
FileRow wrong_row(const std::string& name, Comparison row, Status before) {
    row.verdict = Verdict::wrong;
    row.words = verdict_text(row);
    FileRow wrong{name, row};
    wrong.is_newly_wrong = before != Status::wrong;
    return wrong;
}

struct Timed {
    std::uint32_t cell_id;
    std::uint64_t content;
    Status status;
    const Times::Phases* phases;
};
std::multimap<std::string, Timed> timed_by_name(const Results& results, const Times& times,
                                                const FileOptions& options) {
    std::map<std::uint32_t, std::uint64_t> content_of;
    for (const auto& scene : results.scenes)
        content_of[scene.scene_id] = scene.content_hash;
    std::map<std::uint32_t, bool> is_peer;
    for (const auto& variant : results.variants)
        is_peer[variant.variant_id] = variant.is_peer != 0;
    std::multimap<std::string, Timed> timed;
    for (const auto& cell : results.cells)
        if (const auto found = times.by_cell().find(cell.cell_id);
            found != times.by_cell().end() && (options.with_peers || !is_peer[cell.variant_id]) &&
            (!options.wanted || options.wanted(cell.name)))
            timed.emplace(cell.name, Timed{cell.cell_id, content_of[cell.scene_id], cell.status,
                                           &found->second});
    return timed;
}

Gate gate_of(const FileRow& row, const FileOptions& options) {
    const Comparison& c = row.comparison;
    if (c.verdict == Verdict::wrong)
        return row.is_newly_wrong ? Gate::fails : Gate::passes;
    if (c.verdict == Verdict::slower && c.ci_lo > 1 + options.fail_if.value_or(0))
        return Gate::fails;
    const bool may_be_told = c.n_pairs >= min_pairs_verdict && c.reason != Reason::too_noisy;
    return may_be_told && row.max_ratio <= 1 + options.fail_if.value_or(options.delta)
               ? Gate::passes
               : Gate::open;
}

} // namespace

FileComparison compare_files(const Results& base, const Results& head, const FileOptions& options) {
    FileComparison result;
    std::set<std::string> common;
    std::ranges::set_intersection(machines_of(base), machines_of(head),
                                  std::inserter(common, common.end()));
    result.is_same_machine = !common.empty();
    const auto floors = {noise_floor(base), noise_floor(head)};
    result.floor = std::max(floors); // an absent one is less than any

    const Times base_times(base, common), head_times(head, common);
    const auto in_base = timed_by_name(base, base_times, options);
    auto in_head = timed_by_name(head, head_times, options);

    std::vector<std::size_t> claims; // rows
    std::vector<std::vector<double>> logs;
    for (const auto& [name, a] : in_base) {
        const auto match = in_head.find(name); // equal names of a merged file match in order
        if (match == in_head.end()) {
            result.only_base.push_back(name);
            // Not timed any more because it throws or crashes: not merely left out.
            for (const auto& cell : head.cells)
                if (cell.name == name && cell.status == Status::wrong)
                    result.rows.push_back(
                        wrong_row(name, row_of(a.cell_id, cell.cell_id, Phase::query), a.status));
            continue;
        }
        const Timed b = match->second;
        in_head.erase(match);
        if (a.content != b.content) {
            result.other_content.push_back(name);
            continue;
        }
        for (const auto& [phase, rounds] : *a.phases) {
            const auto other = b.phases->find(phase);
            if (phase == Phase::build_and_query || phase == Phase::update_and_query ||
                other == b.phases->end())
                continue;
            Comparison row = row_of(a.cell_id, b.cell_id, phase);
            std::vector<double> ratios = log_ratios(rounds, other->second);
            row.n_pairs = ratios.size();
            if (a.status == Status::wrong || b.status == Status::wrong) {
                result.rows.push_back(
                    wrong_row(name, row, b.status == Status::wrong ? a.status : Status::wrong));
                continue;
            }
            claims.push_back(result.rows.size());
            FileRow& added = result.rows.emplace_back(FileRow{name, row});
            std::tie(added.base_ns, added.head_ns) = paired_medians(rounds, other->second);
            added.max_ratio = paired_ratio(ratios).ci_hi;
            logs.push_back(std::move(ratios));
        }
    }
    for (const auto& [name, timed] : in_head)
        result.only_head.push_back(name);
    result.family_size = claims.size();
    const auto rulings = decide(logs, options.delta, result.floor.value_or(0));
    for (std::size_t i = 0; i < claims.size(); ++i)
        set_ruling(result.rows[claims[i]].comparison, rulings[i]);
    result.gate =
        result.only_base.empty() && result.other_content.empty() ? Gate::passes : Gate::open;
    for (FileRow& row : result.rows) {
        row.gate = gate_of(row, options);
        result.gate = std::max(result.gate, row.gate);
    }
    return result;
}

} // namespace boxwood::bench
