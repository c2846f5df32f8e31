#include "bench/policies.h"

#include "bench/contender.h"
#include "bench/text_table.h"

#include <fmt/format.h>

#include <map>
#include <tuple>

namespace boxwood::bench {

std::string policies_text(const RunIndex& index) {
    using results::Cell;
    const std::string frame = "update+query";
    const auto frame_ns = [&](const Cell& cell) {
        return index.median_ns(cell, {"update", "query"});
    };
    struct Sides {
        const Cell *automatic = nullptr, *fixed = nullptr;
    };
    std::map<std::tuple<std::uint32_t, std::uint32_t>, Sides> tasks; // scene, threads
    for (const Cell& cell : index.results().cells) {
        const results::Variant& variant = index.variant(cell);
        if (cell.ask != to_string(Ask::moving_pairs) || variant.is_peer || !index.is_right(cell) ||
            !index.times().rounds(cell.cell_id, frame))
            continue;
        Sides& sides = tasks[{cell.scene_id, cell.threads}];
        const Cell*& side = variant.builder == "auto" ? sides.automatic : sides.fixed;
        if (variant.builder.starts_with("auto_"))
            continue; // with settings of its own
        if (!side || frame_ns(cell) < frame_ns(*side))
            side = &cell;
    }
    TextTable table({"scene", ">n", ">threads", ">auto", "best fixed policy", ">its frame",
                     ">auto/best", "auto is within 10 %"});
    for (const auto& [task, sides] : tasks) {
        if (!sides.automatic || !sides.fixed)
            continue;
        const Cell &ours = *sides.automatic, &best = *sides.fixed;
        const PairedRatio ratio = index.times().ratio(best.cell_id, ours.cell_id, frame);
        const double most = 1 + auto_may_lose;
        const bool known = ratio.n_pairs >= least_pairs_verdict;
        table.add({index.scene(ours).name, std::to_string(ours.n_items),
                   std::to_string(ours.threads), time_text(frame_ns(ours)),
                   index.variant(best).builder, time_text(frame_ns(best)),
                   interval_text(ratio.ratio, ratio.ci_lo, ratio.ci_hi),
                   known && ratio.ci_hi <= most  ? "yes"
                   : known && ratio.ci_lo > most ? "no"
                                                 : "can't tell"});
    }
    return table.empty() ? "" : table.text();
}

} // namespace boxwood::bench
