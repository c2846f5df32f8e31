#include "bench/analysis/frame_times.h"

#include "bench/analysis/ledgers.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

using results::Cell;

constexpr double ms = 1e6, screen_ns = 1e9 / 60;
using Task = std::tuple<std::uint32_t, std::string, std::uint32_t>; // scene, ask, threads

/// The right cells that were timed frame by frame, by what was asked, in the order of the file.
std::vector<std::vector<const Cell*>> tasks_of(const RunIndex& index) {
    std::map<Task, std::size_t> place;
    std::vector<std::vector<const Cell*>> tasks;
    for (const Cell& cell : index.results().cells) {
        if (!index.is_right(cell) || !index.times().rounds(cell.cell_id, frame_phase))
            continue;
        const auto [found, is_new] =
            place.try_emplace({cell.scene_id, cell.task, cell.threads}, tasks.size());
        if (is_new)
            tasks.emplace_back();
        tasks[found->second].push_back(&cell);
    }
    return tasks;
}

/// What an application would run: of whole scenes what they call for, else the best of each library
/// and the policies that it need not choose.
bool is_default(const results::Variant& variant) {
    return variant.name == required_word || variant.builder == "auto" ||
           variant.builder == "cached";
}

/// The quickest of each library, by the median round.
std::map<std::string, const Cell*> best_of(const RunIndex& index,
                                           const std::vector<const Cell*>& cells) {
    std::map<std::string, const Cell*> best;
    for (const Cell* cell : cells) {
        const Cell*& kept = best[index.variant(*cell).library];
        if (!kept || index.frame_ns(*cell) < index.frame_ns(*kept))
            kept = cell;
    }
    return best;
}

std::set<const Cell*> kept_in_brief(const RunIndex& index, const std::vector<const Cell*>& cells) {
    std::set<const Cell*> kept;
    for (const auto& [library, cell] : best_of(index, cells))
        if (cell->task != scene_queries_word)
            kept.insert(cell);
    for (const Cell* cell : cells)
        if (is_default(index.variant(*cell)))
            kept.insert(cell);
    return kept;
}

} // namespace

std::map<std::uint32_t, FrameStats> frame_stats(const results::Results& results) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<double>> rounds; // cell, frame
    for (const results::FrameRow& row : results.frames)
        rounds[{row.cell_id, row.frame}].push_back(row.update_ns + row.query_ns);
    std::map<std::uint32_t, std::vector<double>> frames;
    for (auto& [key, times] : rounds)
        frames[key.first].push_back(median_interval(std::move(times)).mid);
    std::map<std::uint32_t, FrameStats> stats;
    for (auto& [cell, times] : frames) {
        std::ranges::sort(times);
        const auto share_over = [&times = times](double limit) {
            return static_cast<double>(times.end() - std::ranges::upper_bound(times, limit)) /
                   static_cast<double>(times.size());
        };
        stats[cell] = {times.size(),
                       percentile_of_sorted(times, 0.50),
                       percentile_of_sorted(times, 0.95),
                       percentile_of_sorted(times, 0.99),
                       times.back(),
                       share_over(ms),
                       share_over(screen_ns)};
    }
    return stats;
}

std::string frame_times_text(const RunIndex& index, bool brief) {
    const auto stats = frame_stats(index.results());
    TextTable table({"scene", ">n", ">threads", "contender", ">frames", ">p50", ">p95", ">p99",
                     ">worst", ">over 1 ms", ">over 16.6 ms"});
    for (std::vector<const Cell*>& cells : tasks_of(index)) {
        std::erase_if(cells, [&](const Cell* cell) {
            return !stats.contains(cell->cell_id) ||
                   index.variant(*cell).name.starts_with(without_word);
        });
        std::ranges::sort(cells, {}, [&](const Cell* cell) {
            return std::pair(stats.at(cell->cell_id).p50_ns, cell->cell_id);
        });
        const std::set<const Cell*> kept = kept_in_brief(index, cells);
        for (const Cell* cell : cells) {
            if (brief && !kept.contains(cell))
                continue;
            const FrameStats& row = stats.at(cell->cell_id);
            table.add({index.scene(*cell).name, std::to_string(cell->n_items),
                       std::to_string(cell->threads), index.variant(*cell).name,
                       std::to_string(row.n_frames), time_text(row.p50_ns), time_text(row.p95_ns),
                       time_text(row.p99_ns), time_text(row.worst_ns),
                       fmt::format("{:.0f} %", 100 * row.over_1ms),
                       fmt::format("{:.0f} %", 100 * row.over_16ms)});
        }
    }
    return table.empty() ? "" : table.text();
}

std::string frame_peers_text(const RunIndex& index) {
    TextTable table({"scene", ">n", ">threads", "best of ours", ">its frame", "best peer",
                     ">its frame", "peer/ours", "peers that ran"});
    for (const std::vector<const Cell*>& cells : tasks_of(index)) {
        const Cell *ours = nullptr, *peer = nullptr;
        std::string ran;
        for (const auto& [library, cell] : best_of(index, cells)) {
            const bool is_peer = index.variant(*cell).is_peer != 0;
            const Cell*& side = is_peer ? peer : ours;
            if (!side || index.frame_ns(*cell) < index.frame_ns(*side))
                side = cell;
            if (is_peer)
                ran += (ran.empty() ? "" : ", ") + library;
        }
        if (!ours || !peer)
            continue;
        const PairedRatio ratio = index.times().ratio(ours->cell_id, peer->cell_id, frame_phase);
        table.add({index.scene(*ours).name, std::to_string(ours->n_items),
                   std::to_string(ours->threads), index.variant(*ours).name,
                   time_text(index.frame_ns(*ours)), index.variant(*peer).name,
                   time_text(index.frame_ns(*peer)),
                   interval_text(ratio.ratio, ratio.ci_lo, ratio.ci_hi), ran});
    }
    return table.empty() ? "" : table.text();
}

} // namespace boxwood::bench
