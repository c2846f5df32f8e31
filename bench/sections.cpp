#include "bench/sections.h"

#include "bench/growth.h"
#include "bench/policies.h"
#include "bench/rankings.h"
#include "bench/speed_ups.h"
#include "bench/tree_rankings.h"

#include <utility>

namespace boxwood::bench {

std::string sections_text(const results::Results& results,
                          std::span<const results::Comparison> comparisons) {
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
        {"The policy auto against the best fixed one: update and query of a frame",
         policies_text(index)},
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
