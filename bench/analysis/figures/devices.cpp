#include "bench/analysis/figures/devices.h"

#include "bench/analysis/comparisons.h"
#include "bench/analysis/index.h"
#include "bench/analysis/wording.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <string_view>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::DeviceBreakEven;
using results::DeviceGain;
using results::Phase;
using results::Results;
using results::Verdict;

DeviceGain gain_of(const DeviceRace& race, const Results& results, const Times& times,
                   const MedianIndex& medians) {
    const Cell& device = *race.device;
    DeviceGain row;
    row.scene_id = device.scene_id;
    row.task = device.task;
    row.n = device.n_items;
    row.cell_device = device.cell_id;
    row.end_to_end_ns = medians.ns(device.cell_id, race.total);
    row.device_ns = medians.ns(device.cell_id, Phase::device_build);
    if (race.total == Phase::build_and_query)
        row.device_ns += medians.ns(device.cell_id, Phase::device_query);
    if (race.resident) {
        row.cell_resident = race.resident->cell_id;
        row.resident_ns = shared_median(times, *race.resident, device, race.total);
    }
    if (race.graph) {
        row.cell_graph = race.graph->cell_id;
        row.graph_ns = shared_median(times, *race.graph, device, race.total);
    }
    if (race.fastest)
        row.cell_cpu = race.fastest->cell_id;
    for (const auto& [threads, cell] : race.processors) {
        const double ns = shared_median(times, *cell, device, race.total);
        if (threads <= 2) {
            (threads == 1 ? row.cpu_1_ns : row.cpu_2_ns) = ns;
            (threads == 1 ? row.cell_1 : row.cell_2) = cell->cell_id;
        }
        row.cpu_all_ns = ns; // the most threads come last
        row.cell_all = cell->cell_id;
        row.threads = threads;
    }
    for (const results::Median& median : results.medians)
        if (median.cell_id == row.cell_device && median.phase == race.total)
            row.limit_ns = median.limit_ns;
    for (const results::Comparison& other : results.compare)
        if (other.family == results::Family::devices && other.cell_a == row.cell_cpu &&
            other.cell_b == row.cell_device) {
            row.ratio = other.ratio;
            row.ci_lo = other.ci_lo;
            row.ci_hi = other.ci_hi;
            row.verdict = other.verdict;
            row.words = other.words;
        }
    return row;
}

std::string break_even_words(const DeviceBreakEven& row, std::uint64_t smallest,
                             std::uint64_t largest, std::string_view items) {
    const bool wins = row.wins_from != results::no_count, loses = row.loses_to != results::no_count;
    const std::string measured =
        smallest == largest ? count_words(largest)
                            : fmt::format("{} to {}", count_words(smallest), count_words(largest));
    const std::string lost = loses ? fmt::format(", loses at {}", count_words(row.loses_to)) : "";
    if (wins && row.wins_from == smallest)
        return fmt::format("wins at all {} {}", measured, items);
    if (wins)
        return fmt::format("wins at {} {} and above{}", count_words(row.wins_from), items,
                           loses ? lost : ", unsure below");
    return fmt::format("{} at {} {}{}", loses ? "no lasting win" : "unsure", measured, items, lost);
}

/// Of one scene and task, by size.
DeviceBreakEven break_even_of(const std::map<std::uint64_t, DeviceGain>& gains,
                              std::string_view items) {
    const auto& [largest, last] = *gains.rbegin();
    DeviceBreakEven row;
    row.scene_id = last.scene_id;
    row.task = last.task;
    row.n_sizes = gains.size();
    row.cell_cpu = last.cell_cpu;
    row.cell_device = last.cell_device;
    for (const auto& [n, gain] : gains) {
        if (gain.verdict == Verdict::slower)
            row.loses_to = n;
        if (gain.verdict != Verdict::faster)
            row.wins_from = results::no_count;
        else if (row.wins_from == results::no_count)
            row.wins_from = n;
    }
    row.words = break_even_words(row, gains.begin()->first, largest, items);
    return row;
}

} // namespace

void set_device_gains(Results& results, const Times& times) {
    const Index index(results);
    const MedianIndex medians(results);
    std::map<std::tuple<std::string, std::string, std::uint64_t>, // task, scene, seed
             std::map<std::uint64_t, DeviceGain>>                 // and by size
        lines;
    for (const DeviceRace& race : device_races(index, times)) {
        const results::SceneRow& scene = index.scene(race.device->scene_id);
        lines[{race.device->task, scene.name, scene.seed}][race.device->n_items] =
            gain_of(race, results, times, medians);
    }
    results.device_gains.clear();
    results.device_break_even.clear();
    for (const auto& [line, gains] : lines) {
        std::map<std::uint64_t, DeviceGain> raced;
        for (const auto& [n, gain] : gains) {
            results.device_gains.push_back(gain);
            if (gain.cell_cpu != results::no_id)
                raced[n] = gain;
        }
        if (raced.empty())
            continue;
        const auto scene_id = gains.rbegin()->second.scene_id;
        const bool of_boxes = index.scene(scene_id).n_triangles == 0;
        results.device_break_even.push_back(break_even_of(raced, of_boxes ? "boxes" : "triangles"));
    }
}

} // namespace boxwood::bench
