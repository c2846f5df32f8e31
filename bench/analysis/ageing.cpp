#include "bench/analysis/ageing.h"

#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::FrameRow;

constexpr std::size_t least_frames = 10;

/// One way to keep a tree over the frames of one scene.
struct Aged {
    const Cell* cell;
    std::size_t frames;
    const FrameRow *first, *last;

    double tests_growth() const {
        return first->box_tests > 0
                   ? static_cast<double>(last->box_tests) / static_cast<double>(first->box_tests)
                   : unknown;
    }
    double sah_growth() const { return first->sah > 0 ? last->sah / first->sah : unknown; }
};

/// By scene, in the order of the file. Counts are the same for any number of threads: the cell of
/// the first number stands for all.
std::map<std::uint32_t, std::vector<Aged>> aged_trees(const RunIndex& index) {
    std::map<std::uint32_t, std::map<std::uint32_t, const FrameRow*>> counted; // cell, frame
    for (const FrameRow& row : index.results().frames)
        if (row.box_tests != results::no_count)
            counted[row.cell_id][row.frame] = &row;
    std::map<std::uint32_t, std::vector<Aged>> scenes;
    for (const Cell& cell : index.results().cells) {
        const auto found = counted.find(cell.cell_id);
        if (found == counted.end() || found->second.size() < least_frames || !index.is_right(cell))
            continue;
        std::vector<Aged>& trees = scenes[cell.scene_id];
        const auto is_same = [&](const Aged& tree) {
            return tree.cell->variant_id == cell.variant_id;
        };
        if (std::ranges::none_of(trees, is_same))
            trees.push_back({&cell, found->second.size(), found->second.begin()->second,
                             found->second.rbegin()->second});
    }
    return scenes;
}

} // namespace

std::string ageing_text(const RunIndex& index, bool brief) {
    TextTable table({"scene", ">n", "policy", ">frames", ">tests of the first, per item",
                     ">last/first", ">SAH of the first", ">last/first"});
    for (const auto& [scene, trees] : aged_trees(index)) {
        const auto oldest = std::ranges::max_element(trees, {}, [](const Aged& tree) {
            const double growth = tree.sah_growth();
            return growth >= 0 ? growth : 0; // unknown ones are not the oldest
        });
        for (const Aged& tree : trees) {
            const std::string& policy = index.variant(*tree.cell).builder;
            if (brief && policy != "auto" && tree.cell != oldest->cell)
                continue;
            const auto n = static_cast<double>(tree.cell->n_items);
            table.add({index.scene(*tree.cell).name, std::to_string(tree.cell->n_items), policy,
                       std::to_string(tree.frames),
                       ratio_text(static_cast<double>(tree.first->box_tests) / n),
                       ratio_text(tree.tests_growth()), ratio_text(tree.first->sah),
                       ratio_text(tree.sah_growth())});
        }
    }
    return table.empty() ? "" : table.text();
}

} // namespace boxwood::bench
