#include "bench/analysis/findings.h"

#include "bench/analysis/comparisons.h"
#include "bench/analysis/status.h"
#include "bench/analysis/times.h"
#include "bench/analysis/wording.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::Comparison;
using results::Finding;
using results::Phase;
using results::Results;
using results::Topic;
using results::Verdict;

/// A finding before the order is known.
struct Draft {
    Finding finding;
    Outcome outcome = Outcome::open;
    double ratio = 1;            ///< the lower, the worse for us
    std::string question, where; ///< "nearest hit, primary rays", "sphere mesh 10k"
    std::string how;             ///< threads and class
    std::uint64_t n_items = 0;
};

class Findings {
  public:
    explicit Findings(const Results& results) : results_(results), medians_(results) {
        for (const results::SceneRow& scene : results.scenes)
            scenes_[scene.scene_id] = &scene;
        for (const results::Variant& variant : results.variants)
            variants_[variant.variant_id] = &variant;
        for (const Cell& cell : results.cells)
            cells_[cell.cell_id] = &cell;
        for (const results::TaskRow& row : results.tasks)
            tasks_[row.task] = &row;
        for (const Comparison& row : results.compare)
            compare_[{row.cell_a, row.cell_b, row.phase, row.contender_class}] = &row;
    }

    std::vector<Finding> all() {
        races();
        kernels();
        scenes();
        choose_headlines();
        std::vector<Finding> findings;
        for (Draft& draft : drafts_) {
            draft.finding.place = static_cast<std::uint32_t>(findings.size());
            findings.push_back(std::move(draft.finding));
        }
        return findings;
    }

  private:
    using RaceKey = std::tuple<std::uint32_t, std::string, std::uint32_t, std::string>; // and class
    struct Sides {
        std::vector<const Cell*> ours, peers;
    };

    const results::Variant& variant(const Cell& cell) const {
        return *variants_.at(cell.variant_id);
    }
    const results::TaskRow& task_named(const std::string& name) const {
        const auto found = tasks_.find(name);
        if (found == tasks_.end())
            throw std::runtime_error(fmt::format("the table tasks has no row '{}'", name));
        return *found->second;
    }

    void races() {
        std::set<std::uint32_t> kernels;
        for (const results::KernelRow& row : results_.kernels)
            kernels.insert(row.cell_id);
        std::map<RaceKey, Sides> jobs;
        for (const Cell& cell : results_.cells)
            if (is_right(cell.status) && !kernels.contains(cell.cell_id) &&
                variant(cell).stages.empty() && scenes_.contains(cell.scene_id))
                for (const std::string& name : split_classes(cell.classes)) {
                    Sides& sides = jobs[{cell.scene_id, cell.task, cell.threads, name}];
                    (variant(cell).is_peer ? sides.peers : sides.ours).push_back(&cell);
                }
        std::set<std::tuple<std::uint32_t, std::string, std::uint32_t>> with_rivals;
        for (const auto& [key, sides] : jobs)
            if (!sides.ours.empty() && !sides.peers.empty())
                with_rivals.insert({std::get<0>(key), std::get<1>(key), std::get<2>(key)});
        for (const auto& [key, sides] : jobs) {
            const auto& [scene, task, threads, name] = key;
            if (sides.ours.empty() ||
                (sides.peers.empty() && with_rivals.contains({scene, task, threads})))
                continue; // a class without rivals of a job that has some says nothing new
            race(key, sides);
        }
    }

    void race(const RaceKey& key, const Sides& sides) {
        const auto& [scene, task, threads, name] = key;
        const Phase total = task_named(task).total;
        Draft draft;
        Finding& row = draft.finding;
        row.topic = Topic::race;
        row.scene_id = scene;
        row.task = task;
        row.threads = threads;
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
        row.certainty = certainty_text(worst) + (is_by_query && together ? " (query)" : "");
        describe(draft, *scenes_.at(scene), sides.ours.front()->n_items);
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
        const Cell* ours = best_of(sides.ours, phase);
        if (!ours)
            return nullptr;
        const Comparison* best = nullptr;
        if (sides.peers.empty()) {
            if (const Cell* reference = reference_of(results_, *ours))
                best = compared(*reference, *ours, phase, "");
        } else {
            for (const Cell* peer : sides.peers) {
                const Comparison* row = compared(*peer, *ours, phase, name);
                if (row &&
                    (!best || medians_.ns(peer->cell_id, phase) < medians_.ns(best->cell_a, phase)))
                    best = row;
            }
        }
        if (best) {
            ours_id = best->cell_b;
            rival_id = best->cell_a;
        }
        return best;
    }

    const Comparison* compared(const Cell& a, const Cell& b, Phase phase,
                               const std::string& name) const {
        const auto found = compare_.find({a.cell_id, b.cell_id, phase, name});
        return found == compare_.end() ? nullptr : found->second;
    }

    /// A peer's library; of ours what tells it from our best.
    std::string rival_words(std::uint32_t rival_id, std::uint32_t ours_id) const {
        const results::Variant& rival = variant(*cells_.at(rival_id));
        const results::Variant& ours = variant(*cells_.at(ours_id));
        return rival.is_peer                   ? rival.library_title
               : rival.builder != ours.builder ? rival.builder
               : rival.layout != ours.layout   ? rival.layout
                                               : rival.kernel;
    }

    void describe(Draft& draft, const results::SceneRow& scene, std::uint64_t n_items) const {
        draft.question = task_named(draft.finding.task).title;
        if (!scene.rays.empty())
            draft.question += ", " + spaced(scene.rays) + " rays";
        draft.n_items = n_items;
        draft.where = scene.human_name.empty() ? spaced(scene.name) + " " + count_words(n_items)
                                               : scene.human_name;
        if (!draft.finding.contender_class.empty())
            draft.how += ", " + draft.finding.contender_class;
        if (draft.finding.threads > 1)
            draft.how += fmt::format(", {} threads", draft.finding.threads);
    }

    void kernels() {
        std::map<std::pair<std::string, std::string>, std::vector<const results::KernelCost*>>
            panels;
        for (const results::KernelCost& cost : results_.kernel_costs)
            if (!cost.is_peer)
                panels[{cost.task, cost.panel}].push_back(&cost); // by rising time
        for (const auto& [key, costs] : panels) {
            const auto right = std::ranges::find_if(
                costs, [](const auto* cost) { return cost->wrong + cost->maybe == 0; });
            Draft draft;
            Finding& row = draft.finding;
            row.topic = Topic::kernel;
            row.task = key.first;
            row.is_headline = 1;
            const results::KernelCost& fastest = *costs.front();
            if (right == costs.end()) {
                draft.outcome = Outcome::loses;
                row.together = "none is always right";
                row.alone = fmt::format("{}, {}", fastest.kernel, time_text(fastest.ns));
                row.certainty = fmt::format("{} of {} wrong", fastest.wrong, fastest.n);
            } else {
                draft.outcome = Outcome::wins;
                draft.ratio = fastest.ns / (*right)->ns;
                row.together = fmt::format("{}, {}", (*right)->kernel, time_text((*right)->ns));
                row.alone = *right == &fastest ? "the fastest of ours"
                                               : fmt::format("{}x {}", short_ratio(1 / draft.ratio),
                                                             fastest.kernel);
                row.certainty = fmt::format("{} right", (*right)->n);
            }
            row.question = fmt::format("{}, {}", task_named(key.first).title, key.second);
            drafts_.push_back(std::move(draft));
        }
    }

    void scenes() {
        for (const Cell& cell : results_.cells) {
            if (!is_right(cell.status) || variant(cell).stages != results::required_stages ||
                !scenes_.contains(cell.scene_id))
                continue;
            Draft draft;
            Finding& row = draft.finding;
            row.topic = Topic::scene;
            row.scene_id = cell.scene_id;
            row.task = cell.task;
            row.threads = cell.threads;
            row.ours = cell.cell_id;
            const double frame = medians_.ns(cell.cell_id, Phase::update_and_query);
            row.together = time_text(frame) + " a frame";
            for (const Comparison& other : results_.compare)
                if (other.cell_a == cell.cell_id && other.family == results::Family::stages &&
                    other.phase == Phase::update_and_query) {
                    row.alone = fmt::format("{}x the time", short_ratio(other.ratio));
                    row.certainty = std::isnan(other.ci_lo)
                                        ? reason_text(other.reason)
                                        : fmt::format("{}-{}", short_ratio(other.ci_lo),
                                                      short_ratio(other.ci_hi));
                    row.rival = other.cell_b;
                }
            describe(draft, *scenes_.at(cell.scene_id), cell.n_items);
            draft.outcome = Outcome::wins;
            draft.ratio = 1e9 / frame; // the slowest first
            drafts_.push_back(std::move(draft));
        }
    }

    /// Orders by what is worst for us, marks one finding per question, and words the questions.
    void choose_headlines() {
        std::ranges::stable_sort(drafts_, {}, [](const Draft& draft) {
            return std::tuple(draft.finding.topic, draft.outcome, draft.ratio);
        });
        const auto question_of = [&](const Draft& draft) {
            return std::tuple(draft.finding.topic, draft.question,
                              scenes_.at(draft.finding.scene_id)->name,
                              draft.finding.contender_class);
        };
        std::map<decltype(question_of(drafts_.front())), std::uint64_t> largest;
        for (const Draft& draft : drafts_)
            if (draft.finding.topic != Topic::kernel)
                largest[question_of(draft)] = std::max(largest[question_of(draft)], draft.n_items);
        for (Draft& draft : drafts_) {
            Finding& row = draft.finding;
            if (row.topic == Topic::kernel)
                continue;
            std::uint64_t& n = largest[question_of(draft)];
            row.is_headline = n == draft.n_items;
            if (row.is_headline)
                n = 0; // the first of that size, and so the worst
            row.question = draft.where + draft.how;
            if (row.topic == Topic::race)
                row.question = draft.question + ", " + row.question;
        }
    }

    const Results& results_;
    MedianIndex medians_;
    std::map<std::uint32_t, const results::SceneRow*> scenes_;
    std::map<std::uint32_t, const results::Variant*> variants_;
    std::map<std::uint32_t, const Cell*> cells_;
    std::map<std::string, const results::TaskRow*> tasks_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, Phase, std::string>, const Comparison*>
        compare_;
    std::vector<Draft> drafts_;
};

} // namespace

std::vector<Finding> findings_of(const Results& results) {
    const bool is_too_noisy = !results.health.empty() && results.health.front().is_too_noisy;
    return is_too_noisy ? std::vector<Finding>{} : Findings(results).all();
}

std::vector<results::TopicRow> topics() {
    return {{Topic::race, "against the best rival, losses first", "rival's time / ours",
             "build + query", "query alone", "interval"},
            {Topic::kernel, "kernels on hard cases", "kernels on hard cases", "cheapest, a call",
             "against our fastest", "errors"},
            {Topic::scene, "moving scenes, a frame", "moving scenes", "what they require",
             "with all stages", "interval"}};
}

} // namespace boxwood::bench
