#include "bench/analysis/policies.h"

#include "bench/tasks/contender.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <map>
#include <tuple>
#include <vector>

namespace boxwood::bench {
namespace {

using results::Cell;

/// Whether a builder is the policy, with or without settings.
bool is_policy(const std::string& builder, const std::string& policy) {
    return builder == policy || builder.starts_with(policy + "_");
}

/// The judged policy with its default settings against the best that is neither it nor auto.
void add_row(TextTable& table, const RunIndex& index, const std::vector<const Cell*>& cells,
             const std::string& policy) {
    const Cell *judged = nullptr, *best = nullptr;
    for (const Cell* cell : cells) {
        const std::string& builder = index.variant(*cell).builder;
        const bool is_fixed = !is_policy(builder, policy) && !is_policy(builder, "auto");
        const Cell*& side = is_fixed ? best : judged;
        if (!is_fixed && builder != policy)
            continue; // with settings of its own
        if (!side || index.frame_ns(*cell) < index.frame_ns(*side))
            side = cell;
    }
    if (!judged || !best)
        return;
    const PairedRatio ratio = index.times().ratio(best->cell_id, judged->cell_id, frame_phase);
    const double most = 1 + auto_may_lose;
    const bool known = ratio.n_pairs >= least_pairs_verdict;
    table.add({index.scene(*judged).name, std::to_string(judged->n_items),
               std::to_string(judged->threads), policy, time_text(index.frame_ns(*judged)),
               index.variant(*best).builder, time_text(index.frame_ns(*best)),
               interval_text(ratio.ratio, ratio.ci_lo, ratio.ci_hi),
               known && ratio.ci_hi <= most  ? "yes"
               : known && ratio.ci_lo > most ? "no"
                                             : "can't tell"});
}

} // namespace

std::string policies_text(const RunIndex& index) {
    std::map<std::tuple<std::uint32_t, std::uint32_t>, std::vector<const Cell*>> tasks;
    for (const Cell& cell : index.results().cells) // by scene and threads
        if (cell.task == to_string(Ask::moving_pairs) && !index.variant(cell).is_peer &&
            index.is_right(cell) && index.times().rounds(cell.cell_id, frame_phase))
            tasks[{cell.scene_id, cell.threads}].push_back(&cell);
    TextTable table({"scene", ">n", ">threads", "policy", ">its frame", "best other", ">its frame",
                     ">policy/best", "within 10 %"});
    for (const auto& [task, cells] : tasks)
        for (const char* policy : {"auto", "cached"})
            add_row(table, index, cells, policy);
    return table.empty() ? "" : table.text();
}

} // namespace boxwood::bench
