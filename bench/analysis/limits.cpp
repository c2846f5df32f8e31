#include "bench/analysis/limits.h"

#include "bench/analysis/statistics.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::missing;
using results::Phase;
using results::Results;

constexpr double box = 24, nodes = 64, pair = 8; // bytes

std::optional<double> counter(const Results& results, const Cell& cell, std::string_view name) {
    for (const results::Counter& row : results.counters)
        if (row.cell_id == cell.cell_id && row.counter == name && row.value != results::no_count)
            return static_cast<double>(row.value);
    return std::nullopt;
}

/// A device counts no box tests: those of the same contender on processors, where both walk the
/// same tree in the same way, which is that of packed alone.
std::optional<double> box_tests(const Results& results, const Cell& cell) {
    if (const auto counted = counter(results, cell, "box_tests"))
        return counted;
    const auto variant =
        std::ranges::find(results.variants, cell.variant_id, &results::Variant::variant_id);
    if (variant == results.variants.end() || variant->layout != "packed")
        return std::nullopt;
    for (const Cell& other : results.cells)
        if (other.scene_id == cell.scene_id && other.task == cell.task &&
            other.variant_id == cell.variant_id && other.precision == cell.precision)
            if (const auto counted = counter(results, other, "box_tests"))
                return counted;
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

/// NaN where one is.
double longest(std::initializer_list<double> times) {
    double ns = 0;
    for (const double time : times)
        ns = std::isnan(time) || time > ns ? time : ns;
    return ns;
}

double device_limit_ns(const Results& results, const Cell& cell, Phase phase) {
    using results::Shard;
    constexpr double lanes = 128, cycles_per_test = 8; // of a multiprocessor; of a lane
    constexpr double build_passes = 10;                // bounds, codes, four of the sort with its
                                                       // counts, leaves, levels: at most
    const results::Env& env = results.env.front();
    const auto count = [&](std::string_view name) {
        return counter(results, cell, name).value_or(missing);
    };
    // Between passes over the data, and before the first, the device's cache may hold so much of
    // it.
    const double cached =
        env.gpu_l2_bytes == results::no_count ? missing : static_cast<double>(env.gpu_l2_bytes);
    const auto work = [&](std::string_view bytes, double passes, std::string_view launches) {
        const double moved = count(bytes) - passes * cached;
        return longest({(moved < 0 ? 0 : moved) / median_of(results, &Shard::gpu_copy_gbs),
                        count(launches) * median_of(results, &Shard::gpu_launch_ns)});
    };
    const auto crossing = [&](std::string_view bytes, double Shard::*rate) {
        return count(bytes) / median_of(results, rate);
    };
    const auto with = [&](Phase first, Phase second) {
        return device_limit_ns(results, cell, first) + device_limit_ns(results, cell, second);
    };
    const bool crosses = cell.executor == results::device_executor;
    switch (phase) {
    case Phase::upload:
        return crossing("upload_bytes", &Shard::gpu_upload_pageable_gbs) +
               crossing("query_upload_bytes", &Shard::gpu_upload_pageable_gbs);
    case Phase::device_build:
        return work("build_bytes", build_passes, "build_launches");
    case Phase::device_query: {
        const double per_ns = env.gpu_sm == results::no_count
                                  ? missing
                                  : static_cast<double>(env.gpu_sm) * lanes * env.gpu_clock_ghz;
        return longest({work("query_bytes", 1, "query_launches"),
                        cycles_per_test * box_tests(results, cell).value_or(missing) / per_ns});
    }
    case Phase::download:
        return crossing("download_bytes", &Shard::gpu_download_pageable_gbs);
    case Phase::build:
        return device_limit_ns(results, cell, Phase::device_build) +
               (crosses ? crossing("upload_bytes", &Shard::gpu_upload_pageable_gbs) : 0);
    case Phase::query:
        return crosses ? with(Phase::device_query, Phase::download) +
                             crossing("query_upload_bytes", &Shard::gpu_upload_pageable_gbs)
                       : device_limit_ns(results, cell, Phase::device_query);
    case Phase::build_and_query:
        return with(Phase::build, Phase::query);
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
    const results::Env& env = results.env.front();
    const double n = static_cast<double>(cell.n_items);
    const double gbs = cell.threads == 1 ? env.stream_triad_gbs_1 : env.stream_triad_gbs_all;
    if (phase == Phase::build_and_query || phase == Phase::update_and_query)
        return limit_ns(results, cell,
                        phase == Phase::build_and_query ? Phase::build : Phase::update) +
               limit_ns(results, cell, Phase::query);
    if (phase == Phase::build)
        return n * (box + nodes) / gbs;
    if (phase == Phase::update) {
        const double moved = items_moved(results, cell);
        return moved > 0 ? moved * (box + nodes) / gbs : missing; // nothing moves: no bound
    }
    const auto tests = counter(results, cell, "box_tests"), pairs = counter(results, cell, "pairs");
    if (phase != Phase::query || !tests || !pairs)
        return missing;
    constexpr double cycles_per_test = 0.31;
    const double cycles = (cycles_per_test * *tests + *pairs) / cell.threads;
    return std::max((n * box + *pairs * pair) / gbs, cycles / env.core_ghz);
}

} // namespace boxwood::bench
