#include "bench/advice/advice.h"

#include "bench/analysis/index.h"
#include "bench/analysis/status.h"
#include "bench/analysis/times.h"
#include "bench/analysis/wording.h"
#include "bench/io/bad_input.h"
#include "trees/builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood::bench {
namespace {

using results::Phase;

/// One number a round: of all that were timed in it the median.
double of_round(std::vector<double> values) {
    std::ranges::sort(values);
    return median_of_sorted(values);
}

/// "ploc_reinsertion" is "ploc+reinsertion" to who asks for it.
std::string as_given(std::string builder) {
    for (const OptimizerEntry& optimizer : optimizers())
        if (const std::string end = "_" + std::string(optimizer.name); builder.ends_with(end))
            builder[builder.size() - end.size()] = '+';
    return builder;
}

/// A way that takes at most so much of the least time may be chosen for other reasons.
constexpr double nearly = 1.02;

class Adviser {
  public:
    Adviser(const results::Results& results, std::optional<double> wanted)
        : results_(results), index_(results), times_(results), floors_(results, times_) {
        advice_.wanted = wanted;
    }

    Advice advise() {
        collect();
        std::ranges::sort(advice_.ways, {}, &Way::build_ns);
        climb();
        advice_.best = best_for(advice_.wanted.value_or(advice_.n_queries));
        find_as_good();
        find_rival();
        return std::move(advice_);
    }

  private:
    void collect() {
        for (const results::Cell& cell : results_.cells) {
            const Times::Rounds* const build = times_.rounds(cell.cell_id, Phase::build);
            const Times::Rounds* const query = times_.rounds(cell.cell_id, Phase::query);
            if (!is_right(cell.status) || !build || !query)
                continue;
            Way way;
            const results::Variant& variant = index_.variant(cell);
            way.cell_id = cell.cell_id;
            way.build = median_interval(medians_by_round(*build));
            way.query = median_interval(medians_by_round(*query));
            way.build_ns = way.build.mid;
            way.query_ns = way.query.mid;
            if (variant.is_peer) {
                way.name = peer_text(variant);
                rivals_.push_back(std::move(way));
                continue;
            }
            way.builder = as_given(variant.builder);
            way.layout = variant.layout;
            way.name = way.builder + "." + way.layout;
            advice_.ways.push_back(std::move(way));
            if (cell.n_queries > 0)
                advice_.n_queries = static_cast<double>(cell.n_queries);
            advice_.threads = cell.threads;
            advice_.task = cell.task;
            advice_.scene = index_.scene(cell.scene_id).human_name;
        }
        if (advice_.ways.empty())
            throw BadInput("choose: no way to build a tree was timed and answered right");
        const bool is_of_rays = advice_.task.starts_with("rays");
        advice_.query_word = is_of_rays ? "rays" : "queries";
        if (advice_.task == "pairs")
            advice_.n_queries = 1; // one query finds all
    }

    /// Which of the ways take less time in this phase than `from`, beyond noise.
    std::vector<std::size_t> faster_than(std::size_t from, Phase phase) const {
        std::vector<Claim> claims;
        std::vector<std::size_t> of;
        const std::uint32_t a = advice_.ways[from].cell_id;
        for (std::size_t i = 0; i < advice_.ways.size(); ++i) {
            if (i == from)
                continue;
            const std::uint32_t b = advice_.ways[i].cell_id;
            const double floor =
                floors_.of(index_.cell(a), index_.cell(b), phase).value_or(default_delta);
            claims.push_back({times_.log_ratios(a, b, phase), floor});
            of.push_back(i);
        }
        const std::vector<Ruling> rulings = decide(claims, default_delta);
        std::vector<std::size_t> faster;
        for (std::size_t i = 0; i < of.size(); ++i)
            if (rulings[i].verdict == results::Verdict::faster)
                faster.push_back(of[i]);
        return faster;
    }

    /// From the cheapest to build on, each time to what pays for itself first.
    void climb() {
        // Of those that no other is told to build faster than, the one with the fastest queries.
        std::size_t at = 0;
        for (std::size_t i = 1; i < advice_.ways.size(); ++i) {
            const std::vector<std::size_t> cheaper = faster_than(i, Phase::build);
            const bool is_dearer = std::ranges::find(cheaper, std::size_t{0}) != cheaper.end();
            if (!is_dearer && advice_.ways[i].query_ns < advice_.ways[at].query_ns)
                at = i;
        }
        advice_.front = {at};
        for (;;) {
            std::optional<std::size_t> next;
            Step step;
            for (const std::size_t i : faster_than(at, Phase::query)) {
                const MedianInterval queries = break_even(at, i);
                const bool is_sooner = queries.mid < step.queries.mid;
                const bool is_as_soon =
                    next && queries.mid <= step.queries.hi &&
                    advice_.ways[i].query_ns < advice_.ways[*next].query_ns &&
                    total_ns(advice_.ways[i], step.queries.mid) <=
                        nearly * total_ns(advice_.ways[*next], step.queries.mid);
                if (!next || is_sooner || is_as_soon) {
                    next = i;
                    step.queries = queries;
                }
            }
            if (!next)
                break;
            step = step_from(at, *next);
            if (!(step.queries.mid > 0)) { // it is better in both
                advice_.front.back() = *next;
                if (!advice_.steps.empty())
                    advice_.steps.back() =
                        step_from(advice_.front[advice_.front.size() - 2], *next);
            } else {
                advice_.front.push_back(*next);
                advice_.steps.push_back(step);
            }
            at = *next;
        }
        leave_out_what_is_never_best();
    }

    /// Of the front the ways that the next one passes no later than they pass the one before.
    void leave_out_what_is_never_best() {
        for (std::size_t i = 1; i < advice_.steps.size();) {
            if (advice_.steps[i].queries.mid > advice_.steps[i - 1].queries.mid) {
                ++i;
                continue;
            }
            const auto at = static_cast<std::ptrdiff_t>(i);
            advice_.front.erase(advice_.front.begin() + at);
            advice_.steps.erase(advice_.steps.begin() + at);
            advice_.steps[i - 1] = step_from(advice_.front[i - 1], advice_.front[i]);
            i = std::max<std::size_t>(1, i - 1);
        }
    }

    Step step_from(std::size_t a, std::size_t b) const {
        return {break_even(a, b),
                paired_ratio(times_.log_ratios(advice_.ways[b].cell_id, advice_.ways[a].cell_id,
                                               Phase::query))};
    }

    /// After how many queries per build `b` has paid for itself against `a`, round by round.
    MedianInterval break_even(std::size_t a, std::size_t b) const {
        const auto of = [&](std::size_t way, Phase phase) {
            return times_.rounds(advice_.ways[way].cell_id, phase);
        };
        const Times::Rounds &build_a = *of(a, Phase::build), &build_b = *of(b, Phase::build),
                            &query_a = *of(a, Phase::query), &query_b = *of(b, Phase::query);
        std::vector<double> queries;
        for (const auto& [round, values] : build_a) {
            if (!build_b.contains(round) || !query_a.contains(round) || !query_b.contains(round))
                continue;
            const double dearer = of_round(build_b.at(round)) - of_round(values);
            const double saved = of_round(query_a.at(round)) - of_round(query_b.at(round));
            queries.push_back(saved > 0 ? advice_.n_queries * dearer / saved
                                        : std::numeric_limits<double>::infinity());
        }
        return median_interval(std::move(queries));
    }

    double total_ns(const Way& way, double queries) const {
        return bench::total_ns(advice_, way, queries);
    }
    /// One of the front where that costs next to nothing, so that the rule and this agree.
    std::size_t best_for(double queries) const {
        const auto total = [&](std::size_t way) { return total_ns(advice_.ways[way], queries); };
        const std::size_t of_front = std::ranges::min(advice_.front, {}, total);
        std::size_t best = of_front;
        for (std::size_t way = 0; way < advice_.ways.size(); ++way)
            if (total(way) < total(best))
                best = way;
        return total(of_front) <= nearly * total(best) ? of_front : best;
    }

    /// Logs of the time of b over that of a, for a build and so many queries, round by round.
    std::vector<double> total_logs(std::uint32_t a, std::uint32_t b, double queries) const {
        const auto totals = [&](std::uint32_t cell) {
            std::map<Times::RoundKey, double> all;
            const Times::Rounds& query = *times_.rounds(cell, Phase::query);
            for (const auto& [round, values] : *times_.rounds(cell, Phase::build))
                if (query.contains(round))
                    all[round] =
                        of_round(values) + queries / advice_.n_queries * of_round(query.at(round));
            return all;
        };
        const auto of_a = totals(a);
        std::vector<double> logs;
        for (const auto& [round, ns] : totals(b))
            if (of_a.contains(round))
                logs.push_back(std::log(ns / of_a.at(round)));
        return logs;
    }

    double floor_of(const Way& ours, const Way& way) const {
        return floors_
            .of(index_.cell(ours.cell_id), index_.cell(way.cell_id), Phase::build_and_query)
            .value_or(default_delta);
    }
    /// Each of these against ours, for a build and so many queries, decided together.
    std::vector<results::Verdict> verdicts(const Way& ours, const std::vector<const Way*>& others,
                                           double queries) const {
        std::vector<Claim> claims;
        for (const Way* other : others)
            claims.push_back(
                {total_logs(ours.cell_id, other->cell_id, queries), floor_of(ours, *other)});
        std::vector<results::Verdict> all;
        for (const Ruling& ruling : decide(claims, default_delta))
            all.push_back(ruling.verdict);
        return all;
    }
    static bool is_distinct(results::Verdict verdict) {
        return verdict == results::Verdict::faster || verdict == results::Verdict::slower;
    }

    void find_as_good() {
        const double queries = advice_.wanted.value_or(advice_.n_queries);
        const Way& best = advice_.ways[advice_.best];
        std::vector<const Way*> others;
        std::vector<std::size_t> place;
        for (std::size_t i = 0; i < advice_.ways.size(); ++i)
            if (i != advice_.best) {
                others.push_back(&advice_.ways[i]);
                place.push_back(i);
                advice_.floor = std::max(advice_.floor, floor_of(best, advice_.ways[i]));
            }
        const std::vector<results::Verdict> found = verdicts(best, others, queries);
        for (std::size_t i = 0; i < found.size(); ++i)
            if (!is_distinct(found[i]))
                advice_.as_good.push_back(place[i]);
        std::ranges::sort(advice_.as_good, {},
                          [&](std::size_t way) { return total_ns(advice_.ways[way], queries); });
    }

    const Way& best_rival_for(double queries) const {
        return *std::ranges::min_element(rivals_, {},
                                         [&](const Way& way) { return total_ns(way, queries); });
    }

    void find_rival() {
        if (rivals_.empty())
            return;
        const double queries = advice_.wanted.value_or(advice_.n_queries);
        const Way& best = advice_.ways[advice_.best];
        advice_.rival = best_rival_for(queries);
        advice_.rival_ratio =
            paired_ratio(total_logs(best.cell_id, advice_.rival->cell_id, queries));
        advice_.is_rival_distinct = is_distinct(verdicts(best, {&*advice_.rival}, queries)[0]);
        find_losses();
    }

    /// The fastest of the rivals that are faster than ours for sure, all judged together.
    const Way* faster_rival(const Way& ours, double queries) const {
        std::vector<const Way*> rivals;
        for (const Way& rival : rivals_)
            rivals.push_back(&rival);
        const std::vector<results::Verdict> found = verdicts(ours, rivals, queries);
        const Way* fastest = nullptr;
        for (std::size_t i = 0; i < found.size(); ++i)
            if (found[i] == results::Verdict::faster &&
                (!fastest || total_ns(*rivals[i], queries) < total_ns(*fastest, queries)))
                fastest = rivals[i];
        return fastest;
    }

    /// From few queries per build to more than anybody makes.
    void find_losses() {
        constexpr double step = 1.1, last = 1e10, gap = 1.5; // a shorter gap is none
        for (double queries = 1; queries < last; queries *= step) {
            const Way& ours = advice_.ways[best_for(queries)];
            const Way* const rival = faster_rival(ours, queries);
            std::vector<Loss>& losses = advice_.losses;
            if (!rival) {
                if (!losses.empty() && std::isnan(losses.back().to))
                    losses.back().to = queries;
                continue;
            }
            if (losses.empty() ||
                (!std::isnan(losses.back().to) && queries > gap * losses.back().to))
                losses.push_back({queries, unknown, {}, unknown});
            Loss& loss = losses.back();
            loss.to = unknown;
            if (std::ranges::find(loss.peers, rival->name) == loss.peers.end())
                loss.peers.push_back(rival->name);
            loss.query_ratio = rival->query_ns / ours.query_ns;
        }
    }

    const results::Results& results_;
    Index index_;
    Times times_;
    NoiseFloors floors_;
    std::vector<Way> rivals_;
    Advice advice_;
};

} // namespace

Advice advise(const results::Results& results, std::optional<double> wanted) {
    return Adviser(results, wanted).advise();
}

} // namespace boxwood::bench
