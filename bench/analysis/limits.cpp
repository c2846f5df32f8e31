#include "bench/analysis/limits.h"

#include "bench/analysis/statistics.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::missing;
using results::Phase;
using results::Results;

constexpr double box = 24, pair = 8; // bytes

std::optional<double> counter(const Results& results, const Cell& cell, std::string_view name) {
    for (const results::Counter& row : results.counters)
        if (row.cell_id == cell.cell_id && row.counter == name && row.value != results::no_count)
            return static_cast<double>(row.value);
    return std::nullopt;
}

/// In a frame, where that was counted, else all.
double items_moved(const Results& results, const Cell& cell) {
    const auto moved = counter(results, cell, "items_moved");
    const auto scene =
        std::ranges::find(results.scenes, cell.scene_id, &results::SceneRow::scene_id);
    if (!moved || scene == results.scenes.end() || scene->n_frames == 0)
        return static_cast<double>(cell.n_items);
    return *moved / static_cast<double>(scene->n_frames);
}

/// Of the rounds that have one.
double median_of(const Results& results, double results::Shard::*rate) {
    std::vector<double> values;
    for (const results::Shard& shard : results.shards)
        if (!std::isnan(shard.*rate))
            values.push_back(shard.*rate);
    return median_interval(std::move(values)).mid;
}

double at_least_0(double bytes) { return bytes < 0 ? 0 : bytes; }

/// What must move of so many bytes that are read or written once, at whichever level takes longer:
/// between core and first cache, or beyond the last cache, which may hold as much as it can.
double moving_ns(const results::Env& env, unsigned threads, double bytes) {
    // Two loads of 64 bytes a cycle, the most that a core of today does. A triad moves a line that
    // it writes twice, so 32 bytes where STREAM counts 24.
    constexpr double bytes_per_cycle = 128, moved_per_counted = 32. / 24;
    const double gbs = threads == 1 ? env.stream_triad_gbs_1 : env.stream_triad_gbs_all;
    const double cached =
        env.l3_bytes == results::no_count ? missing : static_cast<double>(env.l3_bytes);
    const double in_core = bytes / (bytes_per_cycle * threads * env.core_ghz);
    const double from_memory = at_least_0(bytes - cached) / (gbs * moved_per_counted);
    return std::isnan(from_memory) ? in_core : std::max(in_core, from_memory);
}

double device_limit_ns(const Results& results, const Cell& cell, Phase phase) {
    using results::Shard;
    const results::Env& env = results.env.front();
    const auto count = [&](std::string_view name) {
        return counter(results, cell, name).value_or(missing);
    };
    const double cached =
        env.gpu_l2_bytes == results::no_count ? 0 : static_cast<double>(env.gpu_l2_bytes);
    const auto work = [&](double bytes) {
        const double moved = at_least_0(bytes - cached) / median_of(results, &Shard::gpu_copy_gbs);
        return std::isnan(moved) ? missing
                                 : std::max(moved, median_of(results, &Shard::gpu_launch_ns));
    };
    const auto up = [&](std::string_view bytes) {
        return count(bytes) / median_of(results, &Shard::gpu_upload_pageable_gbs);
    };
    const auto limit = [&](Phase part) { return device_limit_ns(results, cell, part); };
    const bool crosses = cell.executor == results::device_executor;
    switch (phase) {
    case Phase::upload:
        return up("upload_bytes") + up("query_upload_bytes");
    case Phase::device_build:
        return work(box * static_cast<double>(cell.n_items));
    case Phase::device_query:
        return work(count("download_bytes"));
    case Phase::download:
        return count("download_bytes") / median_of(results, &Shard::gpu_download_pageable_gbs);
    case Phase::build:
        return limit(Phase::device_build) + (crosses ? up("upload_bytes") : 0);
    case Phase::query:
        return limit(Phase::device_query) +
               (crosses ? limit(Phase::download) + up("query_upload_bytes") : 0);
    case Phase::build_and_query:
        return limit(Phase::build) + limit(Phase::query);
    default:
        return missing;
    }
}

} // namespace

double limit_ns(const Results& results, const Cell& cell, Phase phase) {
    if (results.env.size() != 1)
        return missing;
    if (is_device(cell))
        return device_limit_ns(results, cell, phase);
    const auto bytes_of = [&](Phase part) {
        if (part == Phase::build)
            return box * static_cast<double>(cell.n_items);
        if (part == Phase::update)
            return box * items_moved(results, cell);
        const auto pairs = counter(results, cell, "pairs");
        return part == Phase::query && pairs ? pair * *pairs : missing;
    };
    const double bytes =
        phase == Phase::build_and_query    ? bytes_of(Phase::build) + bytes_of(Phase::query)
        : phase == Phase::update_and_query ? bytes_of(Phase::update) + bytes_of(Phase::query)
                                           : bytes_of(phase);
    return bytes > 0 ? moving_ns(results.env.front(), cell.threads, bytes) : missing;
}

} // namespace boxwood::bench
