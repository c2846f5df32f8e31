#include "bench/analysis/figures/frames.h"

#include "bench/analysis/job.h"
#include "bench/analysis/statistics.h"
#include "bench/analysis/status.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::FrameMedian;
using results::FrameRow;
using results::FrameStats;
using results::Results;

constexpr std::string_view rebuilt_every_frame = "rebuild_trigger0"; // a builder
constexpr double ms = 1e6, screen_ns = 1e9 / 60;

/// The times of one frame by round, and its counts.
struct Frame {
    std::vector<double> both, query;
    double box_tests = results::missing, sah = results::missing;
};

std::map<std::uint32_t, std::map<std::uint32_t, Frame>> frames_of(const Results& results) {
    std::map<std::uint32_t, std::map<std::uint32_t, Frame>> cells;
    for (const FrameRow& row : results.frames) {
        if (!(row.update_ns + row.query_ns >= 0))
            continue;
        Frame& frame = cells[row.cell_id][row.frame];
        frame.both.push_back(row.update_ns + row.query_ns);
        frame.query.push_back(row.query_ns);
        if (row.box_tests != results::no_count)
            frame.box_tests = static_cast<double>(row.box_tests);
        if (!std::isnan(row.sah))
            frame.sah = row.sah;
    }
    return cells;
}

/// What each cell that has frames is held against; no_id for its own first frame.
std::map<std::uint32_t, std::uint32_t> fresh_cells(const Results& results) {
    std::set<std::uint32_t> with_frames, rebuilt;
    for (const FrameRow& row : results.frames)
        with_frames.insert(row.cell_id);
    for (const results::Variant& variant : results.variants)
        if (variant.builder == rebuilt_every_frame)
            rebuilt.insert(variant.variant_id);
    std::map<JobKey, std::uint32_t> fresh;
    for (const results::Cell& cell : results.cells)
        if (with_frames.contains(cell.cell_id) && rebuilt.contains(cell.variant_id) &&
            is_right(cell.status))
            fresh.emplace(job_of(cell), cell.cell_id); // the first stays
    std::map<std::uint32_t, std::uint32_t> found;
    for (const results::Cell& cell : results.cells)
        if (with_frames.contains(cell.cell_id)) {
            const auto other = fresh.find(job_of(cell));
            found[cell.cell_id] = other == fresh.end() ? results::no_id : other->second;
        }
    return found;
}

double share_above(const std::vector<double>& sorted, double limit) {
    return static_cast<double>(sorted.end() - std::ranges::upper_bound(sorted, limit)) /
           static_cast<double>(sorted.size());
}

} // namespace

std::vector<FrameMedian> frame_medians_of(const Results& results) {
    std::map<std::uint32_t, std::uint64_t> items;
    for (const results::Cell& cell : results.cells)
        items[cell.cell_id] = cell.n_items;
    std::vector<FrameMedian> all;
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> query_ns; // by cell and frame
    for (auto& [cell, frames] : frames_of(results))
        for (auto& [number, frame] : frames) {
            FrameMedian row{cell, number};
            row.frame_ns = median_interval(frame.both).mid;
            row.query_ns = query_ns[{cell, number}] = median_interval(frame.query).mid;
            row.box_tests_per_item = frame.box_tests / static_cast<double>(items[cell]);
            row.sah = frame.sah;
            all.push_back(row);
        }
    const auto fresh = fresh_cells(results);
    double first = results::missing; // of the cell
    for (std::size_t i = 0; i < all.size(); ++i) {
        FrameMedian& row = all[i];
        if (i == 0 || all[i - 1].cell_id != row.cell_id)
            first = row.query_ns;
        const std::uint32_t other = fresh.at(row.cell_id);
        const auto base = query_ns.find({other, row.frame});
        row.over_fresh = row.query_ns / (other == results::no_id  ? first
                                         : base == query_ns.end() ? results::missing
                                                                  : base->second);
    }
    return all;
}

std::vector<FrameStats> frame_stats_of(const Results& results) {
    const auto fresh = fresh_cells(results);
    std::vector<FrameStats> all;
    for (auto row = results.frame_medians.begin(); row != results.frame_medians.end();) {
        const auto first = row;
        std::vector<double> ns;
        for (; row != results.frame_medians.end() && row->cell_id == first->cell_id; ++row)
            ns.push_back(row->frame_ns);
        std::ranges::sort(ns);
        FrameStats stats{first->cell_id, fresh.at(first->cell_id), ns.size()};
        stats.p50_ns = median_of_sorted(ns);
        stats.p95_ns = percentile_of_sorted(ns, 0.95);
        stats.p99_ns = percentile_of_sorted(ns, 0.99);
        stats.max_ns = ns.back();
        stats.over_1_ms = share_above(ns, ms);
        stats.over_16_6_ms = share_above(ns, screen_ns);
        stats.degradation = std::prev(row)->over_fresh / first->over_fresh;
        all.push_back(stats);
    }
    return all;
}

} // namespace boxwood::bench
