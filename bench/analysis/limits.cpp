#include "bench/analysis/limits.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::missing;
using results::Phase;
using results::Results;

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

} // namespace

double limit_ns(const Results& results, const Cell& cell, Phase phase) {
    if (results.env.size() != 1)
        return missing;
    constexpr double box = 24, nodes = 64, pair = 8;
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
