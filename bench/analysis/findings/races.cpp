#include "bench/analysis/comparisons.h"
#include "bench/analysis/figures/kernel_rows.h"
#include "bench/analysis/findings/draft.h"
#include "bench/analysis/job.h"
#include "bench/analysis/status.h"

#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::Comparison;
using results::Finding;
using results::Phase;

/// Our best against the best rival, for each job and class; of kernels those that were never wrong
/// and never without an answer, where that is what a task is judged by.
class Races {
  public:
    Races(const Index& index, const MedianIndex& medians) : index_(index), medians_(medians) {
        // Of these tasks: that no answer is wrong says nothing of how near all are.
        std::set<std::string> by_error;
        for (const results::KernelCost& cost : index.results().kernel_costs)
            if (cost.by_error)
                by_error.insert(cost.task);
        for (const results::KernelRow& row : index.results().kernels)
            if (is_judged(row) && row.wrong + row.maybe == 0 && !by_error.contains(row.task))
                always_right_.insert(row.cell_id);
        for (const Comparison& row : index.results().compare)
            if (row.family == results::Family::peers)
                against_.insert({{row.cell_b, row.phase, row.contender_class}, &row});
            else if (row.family == results::Family::ours)
                compare_[{row.cell_a, row.cell_b, row.phase}] = &row;
    }

    std::vector<Draft> all() {
        std::map<std::pair<JobKey, std::string>, Sides> jobs; // and class
        for (const Cell& cell : index_.results().cells)
            if (may_race(cell))
                for (const std::string& name : split_classes(cell.classes)) {
                    Sides& sides = jobs[{job_of(cell), name}];
                    (index_.is_peer(cell) ? sides.peers : sides.ours).push_back(&cell);
                }
        std::set<JobKey> with_rivals;
        for (const auto& [key, sides] : jobs)
            if (!sides.ours.empty() && !sides.peers.empty())
                with_rivals.insert(key.first);
        for (const auto& [key, sides] : jobs)
            // A class without rivals of a job that has some says nothing new.
            if (!sides.ours.empty() && (!sides.peers.empty() || !with_rivals.contains(key.first)))
                race(key.second, sides);
        return std::move(drafts_);
    }

  private:
    struct Sides {
        std::vector<const Cell*> ours, peers;
    };

    void race(const std::string& name, const Sides& sides) {
        const Cell& first = *sides.ours.front();
        const Phase total = index_.task(first.task).total;
        Draft draft;
        Finding& row = draft.finding;
        row.topic = index_.is_kernel(first) ? results::Topic::call : results::Topic::race;
        row.contender_class = name;
        const Comparison* together = best_pair(sides, total, name, row.ours, row.rival);
        const Comparison* alone =
            total == Phase::build_and_query
                ? best_pair(sides, Phase::query, name, row.ours_alone, row.rival_alone)
                : nullptr;
        if (!together && !alone)
            return;
        const auto rank = [](const Comparison& side) {
            return std::pair(outcome_of(side), 1 / side.ratio);
        };
        const bool is_by_query = !together || (alone && rank(*alone) < rank(*together));
        const Comparison& worst = is_by_query ? *alone : *together;
        std::tie(draft.outcome, draft.ratio) = rank(worst);
        if (together)
            row.together = outcome_text(*together, rival_words(row.rival, row.ours));
        if (alone) {
            const std::string rival = rival_words(row.rival_alone, row.ours_alone);
            const bool is_named = together && rival == rival_words(row.rival, row.ours);
            row.alone = outcome_text(*alone, is_named ? "" : rival);
        }
        const char* const of = !together || !alone ? "" : is_by_query ? "(query)" : "(both)";
        row.certainty = certainty_text(worst, 1 / worst.ci_hi, 1 / worst.ci_lo, of);
        describe(draft, index_, first);
        drafts_.push_back(std::move(draft));
    }

    const Cell* best_of(const std::vector<const Cell*>& cells, Phase phase) const {
        const Cell* best = nullptr;
        for (const Cell* cell : cells)
            if (const double ns = medians_.ns(cell->cell_id, phase);
                !std::isnan(ns) && (!best || ns < medians_.ns(best->cell_id, phase)))
                best = cell;
        return best;
    }

    /// Our best of a phase against the best rival that it was compared with.
    const Comparison* best_pair(const Sides& sides, Phase phase, const std::string& name,
                                std::uint32_t& ours_id, std::uint32_t& rival_id) const {
        std::vector<const Cell*> all = sides.ours;
        if (sides.peers.empty()) // the reference itself is the rival
            std::erase_if(all, [&](const Cell* cell) { return !reference_of(index_, *cell); });
        const Cell* ours = best_of(all, phase);
        if (!ours)
            return nullptr;
        const Comparison* best = nullptr;
        if (sides.peers.empty()) {
            const auto found =
                compare_.find({reference_of(index_, *ours)->cell_id, ours->cell_id, phase});
            best = found == compare_.end() ? nullptr : found->second;
        } else {
            // One that is faster beyond doubt, if there is one; else the fastest.
            const auto rank = [&](const Comparison& row) {
                return std::pair(row.verdict != results::Verdict::slower,
                                 medians_.ns(row.cell_a, phase));
            };
            const auto [first, last] = against_.equal_range({ours->cell_id, phase, name});
            for (auto found = first; found != last; ++found)
                if (const Comparison& row = *found->second;
                    may_race(index_.cell(row.cell_a)) && (!best || rank(row) < rank(*best)))
                    best = &row;
        }
        if (best) {
            ours_id = best->cell_b;
            rival_id = best->cell_a;
        }
        return best;
    }

    /// Of kernels those alone that answered each case, and rightly.
    bool may_race(const Cell& cell) const {
        return is_right(cell.status) && index_.stages(cell).empty() &&
               (!index_.is_kernel(cell) || always_right_.contains(cell.cell_id));
    }

    /// A peer's library; of ours what tells it from our best.
    std::string rival_words(std::uint32_t rival_id, std::uint32_t ours_id) const {
        const results::Variant& rival = index_.variant(index_.cell(rival_id));
        const results::Variant& ours = index_.variant(index_.cell(ours_id));
        const bool by_one = index_.cell(rival_id).threads == 1 && index_.cell(ours_id).threads > 1;
        return rival.is_peer ? rival.library_title + (by_one ? " on 1 thread" : "")
               : rival.builder != ours.builder ? rival.builder
               : rival.layout != ours.layout   ? rival.layout
                                               : rival.kernel;
    }

    const Index& index_;
    const MedianIndex& medians_;
    std::set<std::uint32_t> always_right_; ///< kernels, on their family
    /// By our cell, phase and class.
    std::multimap<std::tuple<std::uint32_t, Phase, std::string>, const Comparison*> against_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, Phase>, const Comparison*> compare_;
    std::vector<Draft> drafts_;
};

} // namespace

std::vector<Draft> race_findings(const Index& index, const MedianIndex& medians) {
    return Races(index, medians).all();
}

} // namespace boxwood::bench
