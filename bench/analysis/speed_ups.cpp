#include "bench/analysis/speed_ups.h"

#include "bench/analysis/rankings.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace boxwood::bench {

std::string speed_ups_text(const RunIndex& index) {
    using results::Cell;
    const std::set<std::uint32_t> ranked = ranked_cells(index);
    const auto is_shown = [&](const Cell& cell) {
        return ranked.contains(cell.cell_id) || cell.task == "build";
    };
    std::vector<std::string> phases;
    for (const char* phase : {"build", "update", "query", "build+query", "update+query"})
        if (std::ranges::any_of(index.results().cells, [&](const Cell& cell) {
                return cell.threads > 1 && index.times().rounds(cell.cell_id, phase);
            }))
            phases.emplace_back(phase);
    std::vector<std::string> headings{"scene", ">n", "task", "ours", "on"};
    for (const std::string& phase : phases)
        headings.push_back(">" + phase);
    TextTable table(headings);
    for (const Cell& many : index.results().cells) {
        if (many.threads == 1 || index.variant(many).is_peer || !index.is_right(many))
            continue;
        const auto one = std::ranges::find_if(index.results().cells, [&](const Cell& cell) {
            return cell.threads == 1 && cell.scene_id == many.scene_id && cell.task == many.task &&
                   cell.variant_id == many.variant_id && cell.precision == many.precision &&
                   index.is_right(cell);
        });
        if (one == index.results().cells.end() || (!is_shown(*one) && !is_shown(many)))
            continue;
        std::vector<std::string> row{index.scene(many).name, std::to_string(many.n_items),
                                     many.task, index.variant(many).name,
                                     fmt::format("{}-{}", many.executor, many.threads)};
        const bool moves = index.times().rounds(many.cell_id, "update") != nullptr;
        for (const std::string& phase : phases) {
            const PairedRatio ratio = index.times().ratio(many.cell_id, one->cell_id, phase);
            row.push_back(moves && phase == "build+query"
                              ? "-"
                              : interval_text(ratio.ratio, ratio.ci_lo, ratio.ci_hi));
        }
        table.add(std::move(row));
    }
    return table.empty() ? "" : table.text();
}

} // namespace boxwood::bench
