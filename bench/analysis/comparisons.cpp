#include "bench/analysis/comparisons.h"

#include "bench/analysis/index.h"
#include "bench/analysis/job.h"
#include "bench/analysis/status.h"
#include "bench/analysis/wording.h"
#include "trees/executor.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::Comparison;
using results::Family;
using results::Phase;
using results::Reason;
using results::Results;
using results::Status;
using results::Verdict;

/// Makes the rows of one family after another.
class Judge {
  public:
    Judge(const Results& results, const Times& times, double delta)
        : times_(times), delta_(delta), floors_(results, times) {
        std::map<std::uint32_t, std::string> machines;
        for (const auto& env : results.env)
            machines[env.env_id] = env.env_hash;
        for (const results::Shard& shard : results.shards)
            if (shard.padding_bytes != results::no_count)
                padding_[{machines[shard.env_id], shard.round}] = shard.padding_bytes;
    }

    /// b against a in one phase, to be decided with the others of its task and the open family.
    void claim(const Cell& a, const Cell& b, Phase phase, const std::string& name = "") {
        std::vector<double> logs = times_.log_ratios(a.cell_id, b.cell_id, phase);
        if (logs.empty())
            return;
        Comparison row;
        row.cell_a = a.cell_id;
        row.cell_b = b.cell_id;
        row.phase = phase;
        row.contender_class = name;
        row.n_pairs = logs.size();
        row.delta = delta_;
        const std::optional<double> floor = floors_.of(a, b, phase);
        row.floor = floor.value_or(results::missing);
        if (a.status == Status::wrong || b.status == Status::wrong) {
            row.verdict = Verdict::wrong;
            row.words = verdict_text(row);
        } else if (!is_right(a.status) || !is_right(b.status)) {
            set_ruling(row, {paired_ratio(logs), results::missing, Verdict::cannot_tell,
                             Reason::unchecked});
        } else {
            Open& open = open_[b.task];
            open.rows.push_back(rows_.size());
            const InputMedians by_input =
                input_medians(logs, times_.inputs(a.cell_id, b.cell_id, phase));
            open.claims.push_back({std::move(logs), floor.value_or(0), by_input});
        }
        rows_.push_back(row);
    }
    void close(Family family) {
        for (const auto& [task, open] : open_) {
            const auto rulings = decide(open.claims, delta_);
            for (std::size_t i = 0; i < rulings.size(); ++i) {
                Ruling ruling = rulings[i];
                const Comparison& row = rows_[open.rows[i]];
                if (ruling.reason == Reason::crosses_1 && flips_with_layout(row))
                    ruling.reason = Reason::memory_layout;
                set_ruling(rows_[open.rows[i]], ruling);
            }
        }
        for (; closed_ < rows_.size(); ++closed_)
            rows_[closed_].family = family;
        open_.clear();
    }
    std::vector<Comparison> take() { return std::move(rows_); }

  private:
    /// Whether all rounds with the smaller environments say one thing, and all with the larger ones
    /// the other, both beyond the noise.
    bool flips_with_layout(const Comparison& row) const {
        const Times::Rounds* const a = times_.rounds(row.cell_a, row.phase);
        const Times::Rounds* const b = times_.rounds(row.cell_b, row.phase);
        std::vector<std::pair<std::uint64_t, double>> by_size;
        for (const auto& [round, ns] : *a)
            if (const auto padding = padding_.find(round);
                padding != padding_.end() && b->contains(round))
                by_size.emplace_back(
                    padding->second,
                    paired_ratio(log_ratios({{round, ns}}, {*b->find(round)})).ratio);
        if (by_size.size() < min_pairs_verdict)
            return false;
        std::ranges::sort(by_size);
        const auto half = static_cast<std::ptrdiff_t>(by_size.size() / 2);
        const double beyond = 1 + (std::isnan(row.floor) ? 0 : row.floor);
        const auto all = [&](auto from, auto to, bool is_slower) {
            return std::all_of(from, to, [&](const auto& round) {
                return is_slower ? round.second > beyond : round.second * beyond < 1;
            });
        };
        const auto begin = by_size.begin(), end = by_size.end();
        return (all(begin, begin + half, true) && all(end - half, end, false)) ||
               (all(begin, begin + half, false) && all(end - half, end, true));
    }

    const Times& times_;
    double delta_;
    NoiseFloors floors_;
    std::map<Times::RoundKey, std::uint64_t> padding_; ///< bytes added to the environment
    std::vector<Comparison> rows_;
    std::size_t closed_ = 0;
    struct Open {
        std::vector<std::size_t> rows; ///< that are to be decided
        std::vector<Claim> claims;
    };
    std::map<std::string, Open> open_; ///< of the open family, by task
};

std::vector<Phase> phases_of(const Times& times, const Cell& cell) {
    std::vector<Phase> phases;
    if (const auto timed = times.by_cell().find(cell.cell_id); timed != times.by_cell().end())
        for (const auto& [phase, rounds] : timed->second)
            phases.push_back(phase);
    return phases;
}

/// Of builders alone: whether the one that takes less time pays for it by a dearer tree, so that a
/// ratio of times would tell half. Else they are compared at equal cost, or one is better in both.
bool trades_off(const Index& index, const Times& times, const Cell& a, const Cell& b, Phase phase) {
    constexpr double equal = 1.01;
    const double of_a = index.tree_cost(a), of_b = index.tree_cost(b);
    if (phase != Phase::build || std::isnan(of_a) || std::isnan(of_b) ||
        index.task(b.task).total != Phase::build)
        return false;
    const std::vector<double> logs = times.log_ratios(a.cell_id, b.cell_id, phase);
    if (logs.empty())
        return false;
    return paired_ratio(logs).ratio < 1 ? of_b > equal * of_a : of_a > equal * of_b;
}

/// A contender and what it does, whatever its threads.
using Contender = std::tuple<std::uint32_t, std::string, std::uint32_t, std::string, std::string>;
Contender contender_of(const Cell& cell) {
    return {cell.scene_id, cell.task, cell.variant_id, cell.precision, cell.classes};
}

/// On one thread, of the usual executor if there is one.
std::map<Contender, const Cell*> on_one_thread(const Index& index) {
    const std::string_view usual = default_executor(1);
    std::map<Contender, const Cell*> single;
    for (const Cell& cell : index.results().cells)
        if (cell.threads == 1 && !is_device(cell) && !index.is_kernel(cell)) {
            const Cell*& kept = single[contender_of(cell)];
            if (!kept || (kept->executor != usual && cell.executor == usual))
                kept = &cell;
        }
    return single;
}

void against_peers(const Index& index, const Times& times, Judge& judge) {
    std::map<std::pair<JobKey, std::string>, std::vector<const Cell*>> peers_of; // and class
    for (const Cell& cell : index.results().cells)
        if (index.is_peer(cell))
            for (const std::string& name : split_classes(cell.classes))
                peers_of[{job_of(cell), name}].push_back(&cell);
    const std::map<Contender, const Cell*> single = on_one_thread(index);
    for (auto& [key, peers] : peers_of)
        if (const auto& [scene, task, threads, device] = key.first; threads > 1 && device.empty()) {
            std::set<std::uint32_t> with_threads;
            for (const Cell* peer : peers)
                with_threads.insert(peer->variant_id);
            for (const auto& [contender, cell] : single)
                if (cell->scene_id == scene && cell->task == task && index.is_peer(*cell) &&
                    is_right(cell->status) && !with_threads.contains(cell->variant_id) &&
                    std::ranges::count(split_classes(cell->classes), key.second))
                    peers.push_back(cell);
        }
    const auto at_its_best = [&](const Cell& peer, Phase phase) -> const Cell& {
        const auto one =
            peer.threads > 1 && !is_device(peer) ? single.find(contender_of(peer)) : single.end();
        if (one == single.end() || !is_right(one->second->status))
            return peer;
        if (peer.status == Status::unsupported)
            return *one->second;
        const std::vector<double> logs =
            times.log_ratios(one->second->cell_id, peer.cell_id, phase);
        return !logs.empty() && paired_ratio(logs).ratio > 1 ? *one->second : peer;
    };
    for (const Cell& ours : index.results().cells) {
        if (index.is_peer(ours))
            continue;
        for (const std::string& name : split_classes(ours.classes))
            for (const Phase phase : phases_of(times, ours)) {
                for (const Cell* peer : peers_of[{job_of(ours), name}]) {
                    const Cell& rival = at_its_best(*peer, phase);
                    if ((phase == Phase::build_and_query || phase == Phase::update_and_query ||
                         phase == Phase::cold_build_and_query || index.divide_alike(ours, rival)) &&
                        !trades_off(index, times, rival, ours, phase))
                        judge.claim(rival, ours, phase, name);
                }
            }
    }
    judge.close(Family::peers);
}

/// Claims that come one by one, put together by a key and the phase.
template <class Key> class Grouped {
  public:
    void add(const Key& key, const Index& index, const Times& times, const Cell& a, const Cell& b) {
        for (const Phase phase : phases_of(times, b))
            if (!trades_off(index, times, a, b, phase))
                claims_[{key, phase}].emplace_back(&a, &b);
    }
    void judge(Judge& judge, Family family) const {
        for (const auto& [key, pairs] : claims_)
            for (const auto& [a, b] : pairs)
                judge.claim(*a, *b, key.second);
        judge.close(family);
    }

  private:
    std::map<std::pair<Key, Phase>, std::vector<std::pair<const Cell*, const Cell*>>> claims_;
};

void against_ours(const Index& index, const Times& times, Judge& judge) {
    Grouped<JobKey> claims;
    for (const Cell& cell : index.results().cells)
        if (const Cell* reference = reference_of(index, cell))
            claims.add(job_of(cell), index, times, *reference, cell);
    claims.judge(judge, Family::ours);
}

void against_one_thread(const Index& index, const Times& times, Judge& judge) {
    const std::map<Contender, const Cell*> single = on_one_thread(index);
    Grouped<JobKey> claims;
    for (const Cell& cell : index.results().cells)
        if (cell.threads > 1)
            if (const auto one = single.find(contender_of(cell)); one != single.end())
                claims.add(job_of(cell), index, times, *one->second, cell);
    claims.judge(judge, Family::threads);
}

void against_fewer_stages(const Index& index, const Times& times, Judge& judge) {
    using Scene = std::tuple<JobKey, std::string, std::string>; // executor, precision
    const auto scene_of = [](const Cell& cell) {
        return Scene{job_of(cell), cell.executor, cell.precision};
    };
    std::map<Scene, const Cell*> required;
    for (const Cell& cell : index.results().cells)
        if (index.stages(cell) == results::required_stages)
            required[scene_of(cell)] = &cell;
    Grouped<Scene> claims;
    for (const Cell& cell : index.results().cells) {
        if (index.stages(cell).empty() || !required.contains(scene_of(cell)))
            continue;
        const Cell& base = *required.at(scene_of(cell));
        if (index.stages(cell) == results::all_stages)
            claims.add(scene_of(cell), index, times, base, cell);
        else if (&base != &cell)
            claims.add(scene_of(cell), index, times, cell, base);
    }
    claims.judge(judge, Family::stages);
}

void against_processors(const Index& index, const Times& times, Judge& judge) {
    for (const DeviceRace& race : device_races(index, times))
        for (const auto& [threads, cell] : race.processors)
            judge.claim(*cell, *race.device, race.total);
    judge.close(Family::devices);
}

/// What may err, or is not certified, against the same that is exact and certified.
void against_exact(const Index& index, const Times& times, Judge& judge) {
    using Alike =
        std::tuple<JobKey, std::string, std::string, std::string>; // executor, precision, name
    const auto from_mark = [&](const Cell& cell) {
        const std::string& name = index.variant(cell).name;
        return std::min(name.find(results::error_mark), name.find(results::plain_mark));
    };
    const auto alike = [&](const Cell& cell) {
        return Alike{job_of(cell), cell.executor, cell.precision,
                     index.variant(cell).name.substr(0, from_mark(cell))};
    };
    const auto may_err = [&](const Cell& cell) { return from_mark(cell) != std::string::npos; };
    std::map<Alike, const Cell*> exact;
    for (const Cell& cell : index.results().cells)
        if (!index.is_peer(cell) && !may_err(cell))
            exact[alike(cell)] = &cell;
    Grouped<Alike> claims;
    for (const Cell& cell : index.results().cells)
        if (!index.is_peer(cell) && may_err(cell))
            if (const auto base = exact.find(alike(cell)); base != exact.end())
                claims.add(alike(cell), index, times, *base->second, cell);
    claims.judge(judge, Family::errors);
}

} // namespace

const Cell* reference_of(const Index& index, const Cell& judged) {
    if (index.is_peer(judged) || index.is_kernel(judged) || !index.stages(judged).empty())
        return nullptr;
    const results::Variant& variant = index.variant(judged);
    const Cell* best = nullptr;
    int best_fit = -1;
    for (const Cell& cell : index.results().cells) {
        if (cell.scene_id != judged.scene_id || cell.task != judged.task ||
            cell.threads != judged.threads || index.is_peer(cell) || !is_right(cell.status) ||
            cell.executor != judged.executor || cell.precision != judged.precision ||
            cell.classes != judged.classes)
            continue;
        const results::Variant& other = index.variant(cell);
        const bool is_alike = !variant.is_reference && other.layout == variant.layout &&
                              other.kernel == variant.kernel;
        const int fit = !other.is_reference ? 0 : is_alike ? 2 : 1;
        if (fit > best_fit) {
            best = &cell;
            best_fit = fit;
        }
    }
    return best == &judged ? nullptr : best;
}

double shared_median(const Times& times, const Cell& cell, const Cell& other, Phase phase) {
    const Times::Rounds *of_cell = times.rounds(cell.cell_id, phase),
                        *of_other = times.rounds(other.cell_id, phase);
    return of_cell && of_other ? paired_medians(*of_cell, *of_other).first : unknown;
}

std::vector<DeviceRace> device_races(const Index& index, const Times& times) {
    std::map<std::pair<std::uint32_t, std::string>, std::vector<const Cell*>> ours;
    for (const Cell& cell : index.results().cells)
        if (is_right(cell.status) && !index.is_peer(cell) && !index.is_kernel(cell) &&
            (index.stages(cell).empty() || index.stages(cell) == results::required_stages))
            ours[{cell.scene_id, cell.task}].push_back(&cell);
    const auto is_end_to_end = [](const Cell* cell) {
        return cell->executor == results::device_executor;
    };
    std::vector<DeviceRace> races;
    for (const auto& [key, cells] : ours) {
        if (std::ranges::none_of(cells, is_end_to_end))
            continue;
        DeviceRace race;
        race.total = index.task(key.second).total;
        const auto take = [&](const Cell*& kept, const Cell& cell, const Cell* beside) {
            const auto ns = [&](const Cell& c) {
                return shared_median(times, c, beside ? *beside : c, race.total);
            };
            if (!std::isnan(ns(cell)) && (!kept || ns(cell) < ns(*kept)))
                kept = &cell;
        };
        for (const Cell* cell : cells)
            if (is_end_to_end(cell))
                take(race.device, *cell, nullptr);
        if (!race.device)
            continue;
        for (const Cell* cell : cells)
            if (cell->precision == race.device->precision && !is_end_to_end(cell))
                take(cell->executor == results::graph_executor ? race.graph
                     : is_device(*cell)                        ? race.resident
                                                               : race.processors[cell->threads],
                     *cell, race.device);
        std::erase_if(race.processors, [](const auto& entry) { return !entry.second; });
        const std::uint32_t most = race.processors.empty() ? 0 : race.processors.rbegin()->first;
        std::erase_if(race.processors,
                      [most](const auto& entry) { return entry.first > 2 && entry.first != most; });
        for (const auto& [threads, cell] : race.processors)
            take(race.fastest, *cell, race.device);
        races.push_back(std::move(race));
    }
    return races;
}

void set_ruling(Comparison& row, const Ruling& ruling) {
    row.n_pairs = ruling.ratio.n_pairs;
    row.ratio = ruling.ratio.ratio;
    row.ci_lo = ruling.ratio.ci_lo;
    row.ci_hi = ruling.ratio.ci_hi;
    row.p_adj = ruling.p_adj;
    row.verdict = ruling.verdict;
    row.reason = ruling.reason;
    row.words = verdict_text(row);
}

std::vector<std::string> split_classes(const std::string& classes) {
    std::vector<std::string> names;
    for (std::size_t start = 0; start <= classes.size();) {
        const std::size_t end = std::min(classes.find(',', start), classes.size());
        names.push_back(classes.substr(start, end - start));
        start = end + 1;
    }
    return names;
}

std::vector<Comparison> comparisons_of(const Results& results, const Times& times, double delta) {
    const Index index(results);
    Judge judge(results, times, delta);
    against_peers(index, times, judge);
    against_ours(index, times, judge);
    against_one_thread(index, times, judge);
    against_fewer_stages(index, times, judge);
    against_processors(index, times, judge);
    against_exact(index, times, judge);
    return judge.take();
}

} // namespace boxwood::bench
