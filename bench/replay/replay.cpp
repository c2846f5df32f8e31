#include "bench/replay/replay.h"

#include "bench/replay/shape_truth.h"
#include "bench/tasks/contender.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

/// The least distance of a query that the program ended depends on the order of the pairs.
bool is_of_chance(const RecordedProgram::Call& call) {
    return call.ended && is_distance(call.what);
}

/// Which queries are checked: the first ones, as many as the truth may test pairs.
std::vector<char> checked_queries(const RecordedProgram& program, double max_tests) {
    std::vector<char> checked(program.calls.size(), 0);
    std::size_t registered = 0;
    double tests = 0;
    for (std::size_t i = 0; i < program.calls.size(); ++i) {
        const RecordedProgram::Call& call = program.calls[i];
        const auto n = static_cast<double>(registered);
        switch (call.what) {
        case recording::Call::add:
            registered += call.n_objects;
            break;
        case recording::Call::remove:
            registered -= std::min<std::size_t>(registered, 1);
            break;
        case recording::Call::clear:
            registered = 0;
            break;
        case recording::Call::collide_self:
        case recording::Call::distance_self:
            tests += n * n / 2;
            break;
        case recording::Call::collide_object:
        case recording::Call::collide_others:
        case recording::Call::distance_object:
        case recording::Call::distance_others:
            tests += n * static_cast<double>(call.n_objects);
            break;
        default:
            break;
        }
        checked[i] = is_query(call.what) && !is_of_chance(call) && tests <= max_tests;
    }
    return checked;
}

/// Of a query that the program's callback ended so many pairs overlap; which they are is chance.
bool is_right(const RecordedProgram::Call& call, const ReplayedCall& found,
              const ReplayedCall& truth) {
    if (is_of_chance(call))
        return true;
    if (is_distance(call.what))
        return found.min_distance == truth.min_distance;
    return found.shown == truth.shown && (call.ended || found.keys == truth.keys);
}

/// Distances are equal up to what libccd ends at, 1e-6; which pair ended a query is chance.
bool is_same_with_shapes(const RecordedProgram::Call& call, const ReplayedCall& a,
                         const ReplayedCall& b) {
    if (is_distance(call.what))
        return a.min_distance == b.min_distance ||
               std::abs(a.min_distance - b.min_distance) <=
                   1e-5 + 1e-5 * std::min(a.min_distance, b.min_distance);
    return call.ended ? (a.shown > 0) == (b.shown > 0) : a.shown == b.shown && a.keys == b.keys;
}

/// A round: every manager once, in an order of its own.
class Rounds {
  public:
    Rounds(const RecordedProgram& program, const std::vector<ReplayEntry>& entries,
           ReplayReport& report)
        : program_(program), report_(report) {
        for (const ReplayEntry& entry : entries) {
            if (entry.is_truth)
                continue;
            std::unique_ptr<Replay> made = entry.make(program);
            if (!made) {
                report.left_out.push_back(entry.name);
                continue;
            }
            replays_.push_back(std::move(made));
            ReplayOutcome& outcome = report.outcomes.emplace_back();
            outcome.name = entry.name;
            outcome.summary = entry.summary;
            outcome.is_ours = entry.library == "boxwood";
            outcome.has_shapes = entry.has_shapes;
            outcome.in_floats = entry.in_floats;
            outcome.per_ns.resize(recording::call_names.size());
        }
        order_.resize(replays_.size());
        std::iota(order_.begin(), order_.end(), std::size_t{0});
    }

    /// False: it was ended, and is left out.
    bool run(const std::string& round, const std::function<bool(const std::string&)>& goes_on,
             const std::function<void(ReplayOutcome&, const std::vector<ReplayedCall>&)>& check) {
        std::ranges::shuffle(order_, random_);
        std::vector<std::vector<double>> ns(replays_.size());
        for (const std::size_t of : order_) {
            if (!goes_on(round + ", " + report_.outcomes[of].name))
                return false;
            const bool has_shapes = report_.outcomes[of].has_shapes;
            replays_[of]->run(
                [&](std::size_t i) {
                    return !has_shapes || !is_with_others(program_.calls[i].what);
                },
                calls_);
            check(report_.outcomes[of], calls_);
            ns[of].resize(recording::call_names.size());
            for (std::size_t i = 0; i < calls_.size(); ++i)
                ns[of][static_cast<std::size_t>(program_.calls[i].what)] += calls_[i].ns;
        }
        for (std::size_t of = 0; of < ns.size(); ++of) {
            ReplayOutcome& outcome = report_.outcomes[of];
            outcome.total_ns.push_back(std::accumulate(ns[of].begin(), ns[of].end(), 0.));
            for (std::size_t call = 0; call < ns[of].size(); ++call)
                outcome.per_ns[call].push_back(ns[of][call]);
        }
        return true;
    }

  private:
    const RecordedProgram& program_;
    ReplayReport& report_;
    std::vector<std::unique_ptr<Replay>> replays_;
    std::vector<std::size_t> order_;
    std::vector<ReplayedCall> calls_;
    std::mt19937_64 random_{1};
};

/// Of the first complete round, by the managers' names.
using AnswersOf = std::map<std::string, std::vector<ReplayedCall>>;

/// By bounds, where the truth is not known: each with the answers of the first of the report.
void compare_bounds(const RecordedProgram& program, const std::vector<char>& checked,
                    const AnswersOf& answers, ReplayReport& report) {
    const auto first = report.outcomes.begin();
    for (auto outcome = first; outcome != report.outcomes.end() && !outcome->has_shapes;
         ++outcome) {
        const auto base = answers.find(first->name), own = answers.find(outcome->name);
        if (base == answers.end() || own == answers.end())
            return; // no round is complete
        for (std::size_t i = 0; i < program.calls.size(); ++i)
            if (is_query(program.calls[i].what) && !checked[i] &&
                !is_right(program.calls[i], own->second[i], base->second[i]) &&
                ++outcome->differ == 1)
                outcome->first_differs = i;
    }
}

/// Each with the truth, and where it is not known with the answers of the first of the report that
/// has shapes.
void judge_shapes(const RecordedProgram& program, const ShapeTruth& truth, const AnswersOf& answers,
                  ReplayReport& report) {
    const auto first = std::ranges::find_if(report.outcomes, &ReplayOutcome::has_shapes);
    for (auto outcome = first; outcome != report.outcomes.end(); ++outcome) {
        const auto base = answers.find(first->name), own = answers.find(outcome->name);
        if (base == answers.end() || own == answers.end())
            return; // no round is complete
        for (std::size_t i = 0; i < program.calls.size(); ++i) {
            if (!is_query(program.calls[i].what))
                continue;
            if (!truth.is_checked(i)) {
                if (!is_same_with_shapes(program.calls[i], own->second[i], base->second[i]) &&
                    ++outcome->differ == 1)
                    outcome->first_differs = i;
                continue;
            }
            std::string fault = truth.fault(i, own->second[i], outcome->in_floats);
            if (!fault.empty() && ++outcome->wrong == 1) {
                outcome->first_wrong = i;
                outcome->witness = std::move(fault);
            }
        }
    }
}

} // namespace

ReplayReport replay(const RecordedProgram& program, const std::vector<ReplayEntry>& entries,
                    unsigned rounds, double max_tests,
                    const std::function<bool(const std::string&)>& goes_on) {
    ReplayReport report;
    std::vector<ReplayedCall> truth;
    std::vector<char> checked(program.calls.size(), 0);
    const auto truth_of = std::ranges::find_if(entries, &ReplayEntry::is_truth);
    if (truth_of != entries.end() && goes_on("testing all pairs, for the truth")) {
        checked = checked_queries(program, max_tests);
        truth_of->make(program)->run([&](std::size_t i) { return checked[i] != 0; }, truth);
    }
    for (std::size_t i = 0; i < program.calls.size(); ++i) {
        const RecordedProgram::Call& call = program.calls[i];
        report.n_queries += is_query(call.what);
        report.n_checked += checked[i] != 0;
        report.n_of_chance += is_of_chance(call);
        report.n_too_dear += is_query(call.what) && !checked[i] && !is_of_chance(call);
        const bool was_run = call.ns > 0; // not so in a made program
        if (was_run && checked[i] && !call.ended && !is_distance(call.what) &&
            call.shown < truth[i].shown && ++report.n_missed == 1)
            report.first_missed = i;
    }
    AnswersOf answers;
    Rounds all(program, entries, report);
    const bool has_shapes = std::ranges::any_of(report.outcomes, &ReplayOutcome::has_shapes);
    const ShapeTruth shapes(program, has_shapes ? max_tests : 0, [&] {
        return goes_on("testing triangles, for the truth with shapes");
    });
    report.n_shapes_checked = shapes.n_checked();
    report.n_shapes_too_dear = shapes.n_too_dear();
    for (unsigned round = 0; round < rounds; ++round) {
        const auto check = [&](ReplayOutcome& outcome, const std::vector<ReplayedCall>& calls) {
            if (round > 0)
                return;
            answers[outcome.name] = calls;
            for (std::size_t i = 0; i < calls.size() && !outcome.has_shapes; ++i)
                if (checked[i] && !is_right(program.calls[i], calls[i], truth[i]) &&
                    ++outcome.wrong == 1)
                    outcome.first_wrong = i;
        };
        if (!all.run("round " + std::to_string(round + 1) + "/" + std::to_string(rounds), goes_on,
                     check))
            break;
    }
    std::ranges::stable_sort(report.outcomes, {}, [](const ReplayOutcome& outcome) {
        return std::pair(outcome.has_shapes, !outcome.is_ours);
    });
    compare_bounds(program, checked, answers, report);
    judge_shapes(program, shapes, answers, report);
    return report;
}

std::vector<ReplayEntry> replay_entries() {
    std::vector<ReplayEntry> all = {world_replay()};
    for (const Peer& peer : peers())
        all.insert(all.end(), peer.replays.begin(), peer.replays.end());
    return all;
}

} // namespace boxwood::bench
