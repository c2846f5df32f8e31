#include "bench/analysis/rankings.h"

#include "bench/analysis/ledgers.h"
#include "bench/analysis/limits.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::Comparison;

/// What contenders are ranked by, each by the best of its variants.
struct Measure {
    const char* name; ///< as in results::Comparison
    std::vector<const char*> phases;
};
const std::vector<Measure>& measures() {
    static const std::vector<Measure> all{{"build+query", {"build", "query"}},
                                          {"query", {"query"}},
                                          {"update+query", {"update", "query"}},
                                          {"build", {"build"}}};
    return all;
}

double total_ns(const RunIndex& index, const Cell& cell, const Measure& measure) {
    double total = 0;
    for (const char* phase : measure.phases)
        total += index.median_ns(cell, phase);
    return total;
}

using Task = std::tuple<std::uint32_t, std::string, std::uint32_t, std::string>; // scene, ask,
                                                                                 // threads, lane
using Best = std::map<std::string, const Cell*>;                                 // by library

/// What was timed of a scene, ask and number of threads.
using Phases =
    std::map<std::tuple<std::uint32_t, std::string, std::uint32_t>, std::set<std::string>>;

Phases phases_of(const RunIndex& index) {
    Phases phases;
    for (const Cell& cell : index.results().cells)
        for (const char* phase : {"build", "update", "query"})
            if (index.times().rounds(cell.cell_id, phase))
                phases[{cell.scene_id, cell.task, cell.threads}].insert(phase);
    return phases;
}

/// A build that queries follow is no measure of its own, nor is one query where frames are. Batches
/// have the trees of single rays: they are held against each other by their rays alone.
bool is_ranked(const std::set<std::string>& timed, const Measure& measure, std::string_view lane) {
    const std::string_view name = measure.name;
    if (name == "build")
        return !timed.contains("query");
    if (name == "update+query")
        return true;
    return !timed.contains("update") &&
           (name == "query" || lane == "" || lane.starts_with("against single rays"));
}

std::map<Task, Best> best_of(const RunIndex& index, const Measure& measure) {
    std::map<Task, Best> best;
    const Phases phases = phases_of(index);
    for (const Cell& cell : index.results().cells) {
        const double total = total_ns(index, cell, measure);
        if (cell.task == "build" || cell.task == scene_queries_word || !index.is_right(cell) ||
            std::isinf(total) || !phases.contains({cell.scene_id, cell.task, cell.threads}))
            continue;
        const auto& timed = phases.at({cell.scene_id, cell.task, cell.threads});
        for (const std::string& lane : lanes_of(cell, index.variant(cell))) {
            if (!is_ranked(timed, measure, lane))
                continue;
            const Cell*& kept =
                best[{cell.scene_id, cell.task, cell.threads, lane}][index.variant(cell).library];
            if (!kept || total < total_ns(index, *kept, measure))
                kept = &cell;
        }
    }
    // Lanes that no peer runs in say nothing new.
    std::erase_if(best, [](const auto& entry) {
        return !std::get<3>(entry.first).empty() && entry.second.size() < 2;
    });
    return best;
}

const Comparison* find(std::span<const Comparison> comparisons, const Cell& peer, const Cell& ours,
                       std::string_view phase) {
    for (const Comparison& row : comparisons)
        if (row.cell_a == peer.cell_id && row.cell_b == ours.cell_id && row.phase == phase)
            return &row;
    return nullptr;
}

std::string limit_text(const RunIndex& index, const Cell& cell, const Measure& measure) {
    double limit = 0;
    for (const char* phase : measure.phases)
        limit += limit_ns(index.results(), cell, phase);
    return ratio_text(total_ns(index, cell, measure) / limit);
}

std::string ask_text(const Task& task) {
    return std::get<1>(task) + (std::get<3>(task).empty() ? "" : ", " + std::get<3>(task));
}

/// The ratios to one library in one lane, over all that is asked there.
struct Lane {
    std::vector<double> ratios;
    double least = std::numeric_limits<double>::infinity();
    std::string least_at;
};
/// Powers of ten of n, lane, threads, library.
using LaneKey = std::tuple<int, std::string, std::uint32_t, std::string>;

int decade_of(const Cell& cell) {
    return static_cast<int>(std::lround(std::log10(static_cast<double>(cell.n_items))));
}

std::string means_text(const std::map<LaneKey, Lane>& lanes) {
    TextTable table({"rays", ">n about", ">threads", "library", ">scenes",
                     ">geometric mean, peer/ours", ">least", "at"});
    for (const auto& [key, lane] : lanes) {
        if (lane.ratios.size() < 2)
            continue;
        double logs = 0;
        for (const double ratio : lane.ratios)
            logs += std::log(ratio);
        const auto& [decade, name, threads, library] = key;
        table.add({name, fmt::format("10^{}", decade), std::to_string(threads), library,
                   std::to_string(lane.ratios.size()),
                   ratio_text(std::exp(logs / static_cast<double>(lane.ratios.size()))),
                   ratio_text(lane.least), lane.least_at});
    }
    return table.empty() ? "" : "\n" + table.text();
}

std::string table_text(const RunIndex& index, std::span<const Comparison> comparisons,
                       const Measure& measure) {
    std::vector<std::string> headings{"scene", ">n", "task", ">threads", "best of its library"};
    for (const char* phase : measure.phases)
        headings.push_back(std::string(">") + phase);
    headings.push_back(">times the limit");
    headings.push_back(std::string(measure.name) + ", peer/ours");
    TextTable table(headings);
    std::map<LaneKey, Lane> lanes;
    for (const auto& [task, best] : best_of(index, measure)) {
        const auto ours = best.find("boxwood");
        for (const auto& [library, cell] : best) {
            const std::string& scene = index.scene(*cell).name;
            std::vector<std::string> row{scene, std::to_string(cell->n_items), ask_text(task),
                                         std::to_string(cell->threads), index.variant(*cell).name};
            for (const char* phase : measure.phases)
                row.push_back(time_text(index.median_ns(*cell, phase)));
            row.push_back(library == "boxwood" ? limit_text(index, *cell, measure) : "");
            const Comparison* found = library != "boxwood" && ours != best.end()
                                          ? find(comparisons, *cell, *ours->second, measure.name)
                                          : nullptr;
            if (found) {
                row.push_back(interval_text(1 / found->ratio, 1 / found->ci_hi, 1 / found->ci_lo) +
                              " " + verdict_text(found->verdict));
                const std::string& name = std::get<3>(task);
                if (!name.empty() && std::string_view(measure.name) == "query") {
                    Lane& lane = lanes[{decade_of(*cell), name, cell->threads, library}];
                    lane.ratios.push_back(1 / found->ratio);
                    if (1 / found->ratio < lane.least) {
                        lane.least = 1 / found->ratio;
                        lane.least_at = scene + " " + cell->task;
                    }
                }
            } else if (ours != best.end() && library != "boxwood") {
                row.push_back("-");
            }
            table.add(std::move(row));
        }
    }
    return table.empty() ? "" : table.text() + means_text(lanes);
}

} // namespace

std::vector<std::string> lanes_of(const Cell& cell, const results::Variant& variant) {
    if (!cell.task.starts_with("rays_"))
        return {""};
    std::vector<std::string> lanes;
    if (variant.is_peer) {
        const auto says = [&](const char* part) {
            return variant.name.find(part) != std::string::npos;
        };
        if (says("sect8") || says("sect16") || says("occluded8") || says("occluded16"))
            lanes = {"against packets"};
        else
            lanes = {"against single rays", "batches against single rays"};
        if (says(".robust"))
            for (std::string& lane : lanes)
                lane += ", watertight";
        return lanes;
    }
    if (variant.traversal == "single_rays")
        lanes = {"against single rays"};
    else if (variant.traversal == "sorted_rays")
        lanes = {"against packets"};
    else
        lanes = {"against packets", "batches against single rays"};
    if (variant.kernel == "watertight")
        for (const std::string& lane : std::vector(lanes))
            lanes.push_back(lane + ", watertight");
    return lanes;
}

std::string rankings_text(const RunIndex& index, std::span<const Comparison> comparisons) {
    std::string text;
    for (const Measure& measure : measures())
        if (const std::string table = table_text(index, comparisons, measure); !table.empty())
            text += (text.empty() ? "" : "\n") + table;
    return text;
}

std::set<std::uint32_t> ranked_cells(const RunIndex& index) {
    std::set<std::uint32_t> cells;
    for (const Measure& measure : measures())
        for (const auto& [task, best] : best_of(index, measure))
            if (const auto ours = best.find("boxwood"); ours != best.end())
                cells.insert(ours->second->cell_id);
    return cells;
}

} // namespace boxwood::bench
