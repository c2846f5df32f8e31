#include "bench/analysis/findings.h"

#include "bench/analysis/classes.h"
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
struct Told {
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
        for (const Comparison& row : results.compare)
            compare_[{row.cell_a, row.cell_b, row.phase, row.contender_class}] = &row;
    }

    std::vector<Finding> all() {
        races();
        kernels();
        scenes();
        choose_headlines();
        std::vector<Finding> findings;
        for (Told& told : told_) {
            told.finding.place = static_cast<std::uint32_t>(findings.size());
            findings.push_back(std::move(told.finding));
        }
        return findings;
    }

  private:
    using JobKey = std::tuple<std::uint32_t, std::string, std::uint32_t, std::string>; // and class
    struct Sides {
        std::vector<const Cell*> ours, peers;
    };

    const results::Variant& variant(const Cell& cell) const {
        return *variants_.at(cell.variant_id);
    }
    bool is_played(const Cell& cell) const {
        const std::string& name = variant(cell).name;
        return name == required_variant || name == all_stages_variant ||
               name.starts_with(without_effect);
    }

    void races() {
        std::set<std::uint32_t> kernels;
        for (const results::KernelRow& row : results_.kernels)
            kernels.insert(row.cell_id);
        std::map<JobKey, Sides> jobs;
        for (const Cell& cell : results_.cells)
            if (is_right(cell.status) && !kernels.contains(cell.cell_id) && !is_played(cell) &&
                scenes_.contains(cell.scene_id))
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

    void race(const JobKey& key, const Sides& sides) {
        const auto& [scene, task, threads, name] = key;
        const bool has_updates = has_phase(sides.ours, Phase::update);
        const bool has_queries = has_phase(sides.ours, Phase::query);
        const Phase total = has_updates    ? Phase::update_and_query
                            : !has_queries ? Phase::build
                            : has_phase(sides.ours, Phase::build_and_query) ? Phase::build_and_query
                                                                            : Phase::query;
        Told told;
        Finding& row = told.finding;
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
        told.outcome = Outcome::wins;
        told.ratio = std::numeric_limits<double>::infinity();
        for (const Comparison* side : {together, alone})
            if (side &&
                std::pair(outcome_of(*side), 1 / side->ratio) < std::pair(told.outcome, told.ratio))
                std::tie(told.outcome, told.ratio) = std::tuple(outcome_of(*side), 1 / side->ratio);
        if (together)
            row.together = outcome_text(*together, rival_words(row.rival, row.ours));
        if (alone) {
            const std::string rival = rival_words(row.rival_alone, row.ours_alone);
            const bool is_named = together && rival == rival_words(row.rival, row.ours);
            row.alone = outcome_text(*alone, is_named ? "" : rival);
        }
        row.certainty = certainty_text(together ? *together : *alone);
        describe(told, *scenes_.at(scene), sides.ours.front()->n_items);
        told_.push_back(std::move(told));
    }

    bool has_phase(const std::vector<const Cell*>& cells, Phase phase) const {
        return std::ranges::any_of(cells, [&](const Cell* cell) {
            return !std::isnan(medians_.ns(cell->cell_id, phase));
        });
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
        return rival.is_peer                   ? library_words(rival.library)
               : rival.builder != ours.builder ? rival.builder
               : rival.layout != ours.layout   ? rival.layout
                                               : rival.kernel;
    }

    /// The kind of rays ends the name of their scene.
    static void describe(Told& told, const results::SceneRow& scene, std::uint64_t n_items) {
        told.question = task_words(told.finding.task);
        std::string base = scene.name, where = scene.human_name;
        if (told.finding.task.starts_with("rays_"))
            if (const std::size_t at = base.rfind('_'); at != std::string::npos) {
                const std::string rays = ", " + base.substr(at + 1) + " rays";
                told.question += rays;
                if (where.ends_with(rays))
                    where.resize(where.size() - rays.size());
                base.resize(at);
            }
        told.n_items = n_items;
        told.where = where.empty() ? spaced(base) + " " + count_words(n_items) : std::move(where);
        if (!told.finding.contender_class.empty())
            told.how += ", " + class_words(told.finding.contender_class);
        if (told.finding.threads > 1)
            told.how += fmt::format(", {} threads", told.finding.threads);
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
            Told told;
            Finding& row = told.finding;
            row.topic = Topic::kernel;
            row.task = key.first;
            row.is_headline = 1;
            const results::KernelCost& fastest = *costs.front();
            if (right == costs.end()) {
                told.outcome = Outcome::loses;
                row.together = "none is always right";
                row.alone = fmt::format("{}, {}", fastest.kernel, time_text(fastest.ns));
                row.certainty = fmt::format("{} of {} wrong", fastest.wrong, fastest.n);
            } else {
                told.outcome = Outcome::wins;
                told.ratio = fastest.ns / (*right)->ns;
                row.together = fmt::format("{}, {}", (*right)->kernel, time_text((*right)->ns));
                row.alone = *right == &fastest ? "the fastest of ours"
                                               : fmt::format("{}x {}", short_ratio(1 / told.ratio),
                                                             fastest.kernel);
                row.certainty = fmt::format("{} right", (*right)->n);
            }
            row.question = fmt::format("{}, {}", spaced(key.first), key.second);
            told_.push_back(std::move(told));
        }
    }

    void scenes() {
        for (const Cell& cell : results_.cells) {
            if (!is_right(cell.status) || variant(cell).name != required_variant ||
                !scenes_.contains(cell.scene_id))
                continue;
            Told told;
            Finding& row = told.finding;
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
            describe(told, *scenes_.at(cell.scene_id), cell.n_items);
            told.outcome = Outcome::wins;
            told.ratio = 1e9 / frame; // the slowest first
            told_.push_back(std::move(told));
        }
    }

    /// Orders by what is worst for us, marks one finding per question, and words the questions:
    /// where a task was put to one scene alone, its name says nothing.
    void choose_headlines() {
        std::ranges::stable_sort(told_, {}, [](const Told& told) {
            return std::tuple(told.finding.topic, told.outcome, told.ratio);
        });
        const auto question_of = [&](const Told& told) {
            return std::tuple(told.finding.topic, told.question,
                              scenes_.contains(told.finding.scene_id)
                                  ? scenes_.at(told.finding.scene_id)->name
                                  : "",
                              told.finding.contender_class);
        };
        std::map<decltype(question_of(told_.front())), std::uint64_t> largest;
        for (const Told& told : told_)
            if (told.finding.topic != Topic::kernel)
                largest[question_of(told)] = std::max(largest[question_of(told)], told.n_items);
        std::map<std::string, std::set<std::string>> places; // by task
        for (Told& told : told_) {
            if (told.finding.topic == Topic::kernel)
                continue;
            auto& n = largest[question_of(told)];
            told.finding.is_headline = n == told.n_items;
            if (told.finding.is_headline) {
                n = 0; // the first of that size, and so the worst
                places[told.finding.task].insert(told.where);
            }
        }
        for (Told& told : told_)
            if (told.finding.topic == Topic::scene) {
                told.finding.question = told.where + told.how;
            } else if (told.finding.topic == Topic::race) {
                const bool is_known = told.finding.is_headline &&
                                      places[told.finding.task].size() == 1 &&
                                      told.finding.task.starts_with("rays_");
                told.finding.question =
                    told.question + (is_known ? "" : ", " + told.where) + told.how;
            }
    }

    const Results& results_;
    MedianIndex medians_;
    std::map<std::uint32_t, const results::SceneRow*> scenes_;
    std::map<std::uint32_t, const results::Variant*> variants_;
    std::map<std::uint32_t, const Cell*> cells_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, Phase, std::string>, const Comparison*>
        compare_;
    std::vector<Told> told_;
};

} // namespace

std::vector<Finding> findings_of(const Results& results) { return Findings(results).all(); }

} // namespace boxwood::bench
