#include "bench/analysis/tree_rankings.h"

#include "bench/analysis/rankings.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

namespace boxwood::bench {
namespace {

using results::Cell;

double sah_of(const RunIndex& index, const Cell& cell) {
    for (const results::TreeRow& row : index.results().trees)
        if (row.cell_id == cell.cell_id)
            return row.sah_cost;
    return results::missing;
}

std::string last_word(const std::string& name) { return name.substr(name.rfind('.') + 1); }

bool is_timed(const RunIndex& index, const Cell& cell) {
    return index.is_right(cell) && index.times().rounds(cell.cell_id, "build");
}

} // namespace

std::string tree_rankings_text(const RunIndex& index) {
    using Task = std::tuple<std::uint32_t, std::uint32_t>; // scene, threads
    std::map<Task, std::vector<const Cell*>> tasks;
    std::vector<std::string> peers;
    for (const Cell& cell : index.results().cells) {
        if (cell.task != "build" || !is_timed(index, cell))
            continue;
        tasks[{cell.scene_id, cell.threads}].push_back(&cell);
        const std::string& name = index.variant(cell).name;
        if (index.variant(cell).is_peer && std::ranges::count(peers, name) == 0)
            peers.push_back(name);
    }
    std::vector<std::string> headings{"scene",  ">n",         ">threads", "tree",
                                      ">build", ">M boxes/s", ">SAH"};
    for (const std::string& peer : peers) {
        headings.push_back(">time of " + last_word(peer) + "/ours");
        headings.push_back(">SAH ours/" + last_word(peer));
    }
    TextTable table(headings);
    for (const auto& [task, cells] : tasks)
        for (const Cell* cell : cells) {
            const double ns = index.median_ns(*cell, "build"), sah = sah_of(index, *cell);
            std::vector<std::string> row{index.scene(*cell).name,
                                         std::to_string(cell->n_items),
                                         std::to_string(cell->threads),
                                         index.variant(*cell).name,
                                         time_text(ns),
                                         ratio_text(static_cast<double>(cell->n_items) / ns * 1e3),
                                         ratio_text(sah)};
            for (const std::string& peer : peers) {
                const auto other = std::ranges::find_if(cells, [&](const Cell* candidate) {
                    return index.variant(*candidate).name == peer;
                });
                const bool held = other != cells.end() && !index.variant(*cell).is_peer;
                const PairedRatio ratio =
                    held ? index.times().ratio(cell->cell_id, (*other)->cell_id, "build")
                         : PairedRatio{};
                row.push_back(held ? interval_text(ratio.ratio, ratio.ci_lo, ratio.ci_hi) : "");
                row.push_back(held ? ratio_text(sah / sah_of(index, **other)) : "");
            }
            table.add(std::move(row));
        }
    return table.empty() ? "" : table.text();
}

std::string ray_builds_text(const RunIndex& index) {
    // A mesh, its size, threads, peer and lane; then the tree of ours and what was asked.
    using Key = std::tuple<std::string, std::uint64_t, std::uint32_t, std::string, std::string>;
    struct Reading {
        double build = 0, rays = 0; ///< peer's time over ours
    };
    std::map<Key, std::map<std::string, Reading>> readings;
    for (const Cell& peer : index.results().cells) {
        const results::Variant& theirs = index.variant(peer);
        const std::string lane = lanes_of(peer, theirs).front();
        if (!theirs.is_peer || !lane.starts_with("against single rays") || !is_timed(index, peer))
            continue;
        for (const Cell& cell : index.results().cells) {
            const results::Variant& ours = index.variant(cell);
            const auto lanes = lanes_of(cell, ours);
            if (ours.is_peer || cell.scene_id != peer.scene_id || cell.task != peer.task ||
                cell.threads != peer.threads || !is_timed(index, cell) ||
                std::ranges::find(lanes, lane) == lanes.end())
                continue;
            const results::SceneRow& scene = index.scene(cell);
            const PairedRatio build = index.times().ratio(cell.cell_id, peer.cell_id, "build"),
                              rays = index.times().ratio(cell.cell_id, peer.cell_id, "query");
            if (build.n_pairs == 0 || rays.n_pairs == 0)
                continue;
            Reading& best = readings[{scene.generator, cell.n_items, cell.threads, theirs.library,
                                      lane + "|" + ours.builder + "." + ours.layout}]
                                    [scene.name + " " + cell.task];
            if (rays.ratio > best.rays)
                best = {build.ratio, rays.ratio};
        }
    }
    TextTable table({"mesh", ">n", ">threads", "rays", "tree of ours", ">asks", ">build, peer/ours",
                     ">rays, peer/ours, least", "at"});
    for (const auto& [key, asked] : readings) {
        const auto& [mesh, n, threads, library, tree] = key;
        double logs = 0;
        const auto* worst = &*asked.begin();
        for (const auto& reading : asked) {
            logs += std::log(reading.second.build);
            if (reading.second.rays < worst->second.rays)
                worst = &reading;
        }
        const std::size_t bar = tree.find('|');
        table.add({mesh, std::to_string(n), std::to_string(threads), tree.substr(0, bar),
                   tree.substr(bar + 1), std::to_string(asked.size()),
                   ratio_text(std::exp(logs / static_cast<double>(asked.size()))),
                   ratio_text(worst->second.rays), worst->first});
    }
    return table.empty() ? "" : table.text();
}

} // namespace boxwood::bench
