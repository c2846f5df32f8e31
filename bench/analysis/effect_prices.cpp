#include "bench/analysis/effect_prices.h"

#include "bench/analysis/ledgers.h"
#include "bench/io/text_table.h"

#include <cmath>
#include <vector>

namespace boxwood::bench {
namespace {

using results::Cell;

std::vector<std::string> head_of(const RunIndex& index, const Cell& cell) {
    return {index.scene(cell).name, std::to_string(cell.n_items), std::to_string(cell.threads)};
}

/// Time of b over time of a in a frame, with its interval.
std::string frame_ratio(const RunIndex& index, const Cell& a, const Cell& b) {
    const PairedRatio ratio = index.times().ratio(a.cell_id, b.cell_id, frame_phase);
    return interval_text(ratio.ratio, ratio.ci_lo, ratio.ci_hi);
}

bool is_timed(const RunIndex& index, const Cell* cell) {
    return cell && index.times().rounds(cell->cell_id, frame_phase) != nullptr;
}

} // namespace

std::string everything_text(const RunIndex& index) {
    TextTable table({"scene", ">n", ">threads", ">only what is called for", ">everything on",
                     "everything/called for"});
    for (const PlayedScene& scene : played_scenes(index)) {
        if (!is_timed(index, scene.required) || !is_timed(index, scene.everything))
            continue;
        const Cell &ours = *scene.required, &all = *scene.everything;
        std::vector<std::string> row = head_of(index, ours);
        row.push_back(time_text(index.frame_ns(ours)));
        row.push_back(time_text(index.frame_ns(all)));
        row.push_back(frame_ratio(index, ours, all));
        table.add(std::move(row));
    }
    return table.empty() ? "" : table.text();
}

std::string effect_prices_text(const RunIndex& index) {
    TextTable table({"scene", ">n", ">threads", "effect", ">with it", ">without", ">its price",
                     "with/without"});
    for (const PlayedScene& scene : played_scenes(index))
        for (const Cell* without : scene.without) {
            if (!is_timed(index, scene.required) || !is_timed(index, without))
                continue;
            const double with_ns = index.frame_ns(*scene.required),
                         without_ns = index.frame_ns(*without), price = with_ns - without_ns;
            std::vector<std::string> row = head_of(index, *without);
            row.push_back(index.variant(*without).name.substr(without_word.size()));
            row.push_back(time_text(with_ns));
            row.push_back(time_text(without_ns));
            row.push_back((price < 0 ? "-" : "") + time_text(std::abs(price)));
            row.push_back(frame_ratio(index, *without, *scene.required));
            table.add(std::move(row));
        }
    return table.empty() ? "" : table.text();
}

} // namespace boxwood::bench
