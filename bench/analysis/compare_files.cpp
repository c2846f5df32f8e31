#include "bench/analysis/compare_files.h"
#include "bench/analysis/comparisons.h"
#include "bench/analysis/index.h"
#include "bench/analysis/job.h"
#include "bench/analysis/status.h"
#include "bench/analysis/wording.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

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
    const results::Cell* cell;
    std::uint64_t content;
    Status status;
    const Times::Phases* phases;
};
using ByName = std::multimap<std::string, Timed>;

ByName timed_by_name(const Results& results, const Times& times, bool of_peers,
                     const FileOptions& options) {
    const Index index(results);
    ByName timed;
    for (const auto& cell : results.cells)
        if (const auto found = times.by_cell().find(cell.cell_id);
            found != times.by_cell().end() && index.is_peer(cell) == of_peers &&
            (of_peers || !options.wanted || options.wanted(cell.name)))
            timed.emplace(cell.name, Timed{&cell, index.scene(cell.scene_id).content_hash,
                                           cell.status, &found->second});
    return timed;
}

bool is_sum(Phase phase) {
    return phase == Phase::build_and_query || phase == Phase::update_and_query;
}

/// The cells of one side, ours or the peers', of both files.
class Sides {
  public:
    Sides(const Results& head, ByName in_base, ByName in_head, const NoiseFloors& base_floors,
          const NoiseFloors& head_floors)
        : head_(head), in_base_(std::move(in_base)), in_head_(std::move(in_head)),
          base_floors_(base_floors), head_floors_(head_floors) {}

    /// Adds to what was found; the rows of one job and phase are decided together.
    void compare(const FileOptions& options) {
        for (const auto& [name, a] : in_base_)
            compare_cell(name, a);
        for (const auto& [group, family] : families_) {
            const auto rulings = decide(family.claims, options.delta);
            for (std::size_t i = 0; i < rulings.size(); ++i)
                set_ruling(rows[family.rows[i]].comparison, rulings[i]);
            max_family = std::max(max_family, rulings.size());
        }
    }

    std::vector<FileRow> rows;
    std::vector<Lost> lost;
    std::size_t max_family = 0; ///< claims
    /// All rows of as many rounds as most have, together: of each round the mean of their logs.
    std::vector<double> mean_logs() const {
        std::map<std::size_t, std::size_t> lengths;
        for (const auto& [group, family] : families_)
            for (const Claim& claim : family.claims)
                ++lengths[claim.log_ratios.size()];
        const auto usual = std::ranges::max_element(
            lengths, {}, [](const auto& entry) { return std::pair(entry.second, entry.first); });
        if (usual == lengths.end())
            return {};
        std::vector<double> means(usual->first);
        for (const auto& [group, family] : families_)
            for (const Claim& claim : family.claims)
                for (std::size_t i = 0; claim.log_ratios.size() == means.size() && i < means.size();
                     ++i)
                    means[i] += claim.log_ratios[i] / static_cast<double>(usual->second);
        return means;
    }
    /// Those that the base has not, once compared.
    const ByName& only_head() const { return in_head_; }

  private:
    void compare_cell(const std::string& name, const Timed& a) {
        const auto match = in_head_.find(name); // equal names of a merged file match in order
        if (match == in_head_.end()) {
            lost.push_back({name, "not timed"});
            // Because it throws or crashes: not merely left out.
            for (const auto& cell : head_.cells)
                if (cell.name == name && cell.status == Status::wrong)
                    rows.push_back(wrong_row(
                        name, row_of(a.cell->cell_id, cell.cell_id, Phase::query), a.status));
            return;
        }
        const Timed b = match->second;
        in_head_.erase(match);
        if (a.content != b.content) {
            lost.push_back({name, "another scene"});
            return;
        }
        if (is_right(a.status) && !is_right(b.status) && b.status != Status::wrong)
            lost.push_back({name, "its answer was not checked"});
        for (const auto& [phase, rounds] : *a.phases)
            if (!is_sum(phase))
                compare_phase(name, a, b, phase, rounds);
    }

    void compare_phase(const std::string& name, const Timed& a, const Timed& b, Phase phase,
                       const Times::Rounds& rounds) {
        Comparison row = row_of(a.cell->cell_id, b.cell->cell_id, phase);
        if (a.status == Status::wrong || b.status == Status::wrong) {
            rows.push_back(
                wrong_row(name, row, b.status == Status::wrong ? a.status : Status::wrong));
            return;
        }
        const auto other = b.phases->find(phase);
        if (other == b.phases->end()) {
            lost.push_back({name, std::string(to_string(phase)) + " not timed"});
            return;
        }
        std::vector<double> ratios = log_ratios(rounds, other->second);
        row.n_pairs = ratios.size();
        const std::optional<double> floor =
            std::max(base_floors_.of(*a.cell, phase), head_floors_.of(*b.cell, phase));
        row.floor = floor.value_or(results::missing);
        Family& family = families_[{job_of(*a.cell), phase}];
        family.rows.push_back(rows.size());
        FileRow& added = rows.emplace_back(FileRow{name, row});
        std::tie(added.base_ns, added.head_ns) = paired_medians(rounds, other->second);
        added.max_ratio = paired_ratio(ratios).ci_hi;
        added.is_same_samples = !ratios.empty() && rounds.size() == other->second.size() &&
                                std::ranges::all_of(ratios, [](double log) { return log == 0; });
        family.claims.push_back({std::move(ratios), floor.value_or(0)});
    }

    const Results& head_;
    ByName in_base_, in_head_;
    const NoiseFloors &base_floors_, &head_floors_;
    struct Family {
        std::vector<std::size_t> rows;
        std::vector<Claim> claims;
    };
    std::map<std::pair<JobKey, Phase>, Family> families_;
};

Gate gate_of(const FileRow& row, const FileOptions& options, bool times_count) {
    const Comparison& c = row.comparison;
    const double floor = std::isnan(c.floor) ? 0 : c.floor;
    if (c.verdict == Verdict::wrong)
        return row.is_newly_wrong ? Gate::fails : Gate::passes;
    if (!times_count)
        return Gate::open;
    if (row.is_same_samples)
        return Gate::passes;
    if (c.verdict == Verdict::slower && c.ci_lo > 1 + options.fail_if.value_or(0))
        return Gate::fails;
    const bool may_be_told = c.n_pairs >= min_pairs_verdict &&
                             (floor <= options.limit() || c.verdict == Verdict::faster);
    return may_be_told && row.max_ratio <= 1 + options.limit() ? Gate::passes : Gate::open;
}

std::set<std::string> cpus_of(const Results& results) {
    std::set<std::string> cpus;
    for (const auto& env : results.env)
        cpus.insert(results::processor(env));
    return cpus;
}

std::set<std::string> common(const std::set<std::string>& a, const std::set<std::string>& b) {
    std::set<std::string> both;
    std::ranges::set_intersection(a, b, std::inserter(both, both.end()));
    return both;
}

/// The middle one of the ratios that are known.
double middle_ratio(const std::vector<FileRow>& rows) {
    std::vector<double> ratios;
    for (const FileRow& row : rows)
        if (!std::isnan(row.comparison.ratio))
            ratios.push_back(row.comparison.ratio);
    return median_interval(std::move(ratios)).mid;
}

} // namespace

FileComparison compare_files(const Results& base, const Results& head, const FileOptions& options) {
    FileComparison result;
    const std::set<std::string> machines = common(machines_of(base), machines_of(head));
    result.is_same_machine = !machines.empty();
    result.is_same_cpu = !common(cpus_of(base), cpus_of(head)).empty();
    const Times base_times(base, machines), head_times(head, machines);
    const NoiseFloors base_floors(base, base_times), head_floors(head, head_times);
    result.floor = std::max(base_floors.highest(), head_floors.highest()); // none is less than any
    const auto sides_of = [&](bool of_peers) {
        Sides sides(head, timed_by_name(base, base_times, of_peers, options),
                    timed_by_name(head, head_times, of_peers, options), base_floors, head_floors);
        sides.compare(options);
        return sides;
    };
    result.peers = sides_of(true).rows;
    result.peers_ratio = middle_ratio(result.peers);
    result.peers_moved =
        std::max(result.peers_ratio, 1 / result.peers_ratio) > 1 + options.limit(); // not for NaN
    Sides ours = sides_of(false);
    result.max_family = ours.max_family;
    result.together = paired_ratio(ours.mean_logs());
    for (const auto& [name, timed] : ours.only_head())
        result.only_head.push_back(name);
    result.rows = std::move(ours.rows);
    result.lost = std::move(ours.lost);

    const bool times_count = (result.is_same_cpu || options.any_processor) && !result.peers_moved;
    const bool is_timed = result.max_family > 0;
    result.is_sealed = base.is_sealed && head.is_sealed;
    result.gate = result.lost.empty() && is_timed && result.is_sealed ? Gate::passes : Gate::open;
    for (FileRow& row : result.rows) {
        row.gate = gate_of(row, options, times_count);
        result.gate = std::max(result.gate, row.gate);
    }
    for (FileRow& row : result.peers)
        row.gate = Gate::passes;
    return result;
}

} // namespace boxwood::bench
