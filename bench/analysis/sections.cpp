#include "bench/analysis/sections.h"

#include "bench/analysis/ageing.h"
#include "bench/analysis/effect_prices.h"
#include "bench/analysis/frame_times.h"
#include "bench/analysis/growth.h"
#include "bench/analysis/ledgers.h"
#include "bench/analysis/policies.h"
#include "bench/analysis/rankings.h"
#include "bench/analysis/speed_ups.h"
#include "bench/analysis/tree_rankings.h"

#include <utility>

namespace boxwood::bench {

std::string sections_text(const results::Results& results,
                          std::span<const results::Comparison> comparisons, bool brief) {
    const RunIndex index(results);
    const std::pair<std::string, std::string> sections[] = {
        {"The best of each library; brackets hold the 95 % interval of the paired ratio",
         rankings_text(index, comparisons)},
        {"Trees alone: above 1 our build takes less time, below 1 our tree is the cheaper to walk",
         tree_rankings_text(index)},
        {"Trees for rays: how much sooner they are built, and the least that their rays do",
         ray_builds_text(index)},
        {"More threads against one, ours: the time on one over the time on all",
         speed_ups_text(index)},
        {"Moving scenes, update and query of a frame: ours against the best peer",
         frame_peers_text(index)},
        {"Frame by frame, each frame by its median over the rounds",
         frame_times_text(index, brief)},
        {"The policies auto and cached against the best of the other fixed ones: update and query of "
         "a frame",
         policies_text(index)},
        {"How trees age, counted: the last frame over the first", ageing_text(index, brief)},
        {"Everything on against only what the scene calls for: update and query of a frame",
         everything_text(index)},
        {"What an effect adds to a frame", effect_prices_text(index)},
        {"The effects ledger: what a scene calls for, stage by stage, and what it leaves out",
         ledgers_text(index)},
        {"Growth with n: the fitted exponent, and how far the times are off that line",
         growth_text(index)},
    };
    std::string text;
    for (const auto& [title, table] : sections)
        if (!table.empty())
            text += "\n" + title + "\n" + table;
    return text;
}

} // namespace boxwood::bench
