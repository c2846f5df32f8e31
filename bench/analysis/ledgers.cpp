#include "bench/analysis/ledgers.h"

#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Cell;

std::string memory_text(std::uint64_t bytes) {
    return bytes < 10'240        ? fmt::format("{} B", bytes)
           : bytes < (10u << 20) ? fmt::format("{} KiB", bytes >> 10)
                                 : fmt::format("{} MiB", bytes >> 20);
}

const StageSums* stage_named(const std::vector<StageSums>& stages, const std::string& name) {
    const auto found = std::ranges::find(stages, name, &StageSums::name);
    return found == stages.end() ? nullptr : &*found;
}

double total_ns(const std::vector<StageSums>& stages) {
    double total = 0;
    for (const StageSums& stage : stages)
        total += stage.calls > 0 ? stage.ns : 0;
    return total;
}

/// Time, share and memory of a stage that ran; zeros for one that did not.
void add_cost(std::vector<std::string>& row, const StageSums* stage, double frames, double all) {
    const bool ran = stage && stage->calls > 0;
    row.push_back(ran ? time_text(stage->ns / frames) : "0");
    row.push_back(ran && all > 0 ? fmt::format("{:.0f} %", 100 * stage->ns / all) : "0 %");
    row.push_back(memory_text(stage ? stage->bytes : 0));
}

std::vector<std::string> names_of(const std::vector<StageSums>& one,
                                  const std::vector<StageSums>& other) {
    std::vector<std::string> names;
    for (const std::vector<StageSums>* stages : {&one, &other})
        for (const StageSums& stage : *stages)
            if (std::ranges::count(names, stage.name) == 0)
                names.push_back(stage.name);
    return names;
}

} // namespace

std::map<std::uint32_t, std::vector<StageSums>> stages_of(const results::Results& results) {
    std::map<std::uint32_t, std::vector<StageSums>> by_cell;
    std::map<std::pair<std::uint32_t, std::string>, std::vector<double>> times;
    for (const results::EffectRow& row : results.effects) {
        std::vector<StageSums>& stages = by_cell[row.cell_id];
        if (!stage_named(stages, row.stage))
            stages.push_back({row.stage, row.required != 0, row.calls, row.items, row.bytes});
        times[{row.cell_id, row.stage}].push_back(row.total_ns);
    }
    for (auto& [cell, stages] : by_cell)
        for (StageSums& stage : stages)
            stage.ns = median_interval(times.at({cell, stage.name})).mid;
    return by_cell;
}

std::vector<PlayedScene> played_scenes(const RunIndex& index) {
    using Key = std::tuple<std::uint32_t, std::uint32_t, std::string, std::string>;
    std::map<Key, PlayedScene> scenes;
    std::vector<Key> order;
    for (const Cell& cell : index.results().cells) {
        if (cell.task != scene_queries_word || index.is_wrong(cell))
            continue;
        const Key key{cell.scene_id, cell.threads, cell.executor, cell.precision};
        if (!scenes.contains(key))
            order.push_back(key);
        PlayedScene& scene = scenes[key];
        const std::string& name = index.variant(cell).name;
        if (name == required_word)
            scene.required = &cell;
        else if (name == everything_word)
            scene.everything = &cell;
        else if (name.starts_with(without_word))
            scene.without.push_back(&cell);
    }
    std::vector<PlayedScene> played;
    for (const Key& key : order)
        if (scenes[key].required)
            played.push_back(scenes[key]);
    return played;
}

std::string ledgers_text(const RunIndex& index) {
    const auto stages = stages_of(index.results());
    const std::vector<StageSums> none;
    const auto of = [&](const Cell* cell) -> const std::vector<StageSums>& {
        const auto found = cell ? stages.find(cell->cell_id) : stages.end();
        return found == stages.end() ? none : found->second;
    };
    TextTable table({"scene", ">n", ">threads", "stage", "called for", ">calls", ">items a frame",
                     ">a frame", ">share", ">memory", ">everything on: a frame", ">share",
                     ">memory"});
    std::string left_out;
    for (const PlayedScene& scene : played_scenes(index)) {
        const std::vector<StageSums>&ours = of(scene.required), &all = of(scene.everything);
        if (ours.empty())
            continue;
        const Cell& cell = *scene.required;
        const auto frames =
            static_cast<double>(std::max<std::uint64_t>(1, index.scene(cell).n_frames));
        const double our_ns = total_ns(ours), all_ns = total_ns(all);
        std::vector<std::string> head{index.scene(cell).name, std::to_string(cell.n_items),
                                      std::to_string(cell.threads)};
        std::string idle;
        for (const std::string& name : names_of(ours, all)) {
            const StageSums *mine = stage_named(ours, name), *theirs = stage_named(all, name);
            const bool called = mine && mine->is_required;
            if (!called && !(mine && mine->calls > 0) && !(theirs && theirs->calls > 0)) {
                idle += (idle.empty() ? "" : ", ") + name;
                continue;
            }
            std::vector<std::string> row = head;
            head.assign(3, "");
            row.push_back(name);
            row.push_back(called ? "yes" : "no");
            row.push_back(std::to_string(mine ? mine->calls : 0));
            row.push_back(
                fmt::format("{:.0f}", static_cast<double>(mine ? mine->items : 0) / frames));
            add_cost(row, mine, frames, our_ns);
            if (scene.everything)
                add_cost(row, theirs, frames, all_ns);
            table.add(std::move(row));
        }
        std::vector<std::string> sum{"", "", "", "all stages", "", "", ""};
        sum.push_back(time_text(our_ns / frames));
        if (scene.everything) {
            sum.insert(sum.end(), {"", ""});
            sum.push_back(time_text(all_ns / frames));
        }
        table.add(std::move(sum));
        if (!idle.empty())
            left_out += fmt::format("{} {}: not called for, and so no call, no time, no memory: "
                                    "{}\n",
                                    index.scene(cell).name, cell.n_items, idle);
    }
    return table.empty() ? "" : table.text() + left_out;
}

} // namespace boxwood::bench
