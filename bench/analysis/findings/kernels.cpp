#include "bench/analysis/findings/draft.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace boxwood::bench {

/// For each task and panel the cheapest kernel that is never wrong.
std::vector<Draft> kernel_findings(const Index& index) {
    std::vector<Draft> drafts;
    std::map<std::pair<std::string, std::string>, std::vector<const results::KernelCost*>> panels;
    for (const results::KernelCost& cost : index.results().kernel_costs)
        if (!cost.is_peer)
            panels[{cost.task, cost.panel}].push_back(&cost); // by rising time
    for (const auto& [key, costs] : panels) {
        const auto right = std::ranges::find_if(
            costs, [](const auto* cost) { return cost->wrong + cost->maybe == 0; });
        Draft draft;
        results::Finding& row = draft.finding;
        row.topic = results::Topic::kernel;
        row.task = key.first;
        row.is_headline = 1;
        const results::KernelCost& fastest = *costs.front();
        if (right == costs.end()) {
            draft.outcome = Outcome::loses;
            row.together = "none is always right";
            row.alone = fmt::format("{}, {}", fastest.kernel, time_text(fastest.ns));
            row.certainty = fmt::format("{} of {} wrong", fastest.wrong, fastest.n);
        } else {
            draft.outcome = Outcome::wins;
            draft.ratio = fastest.ns / (*right)->ns;
            row.together = fmt::format("{}, {}", (*right)->kernel, time_text((*right)->ns));
            row.alone = *right == &fastest
                            ? "the fastest of ours"
                            : fmt::format("{}x {}", ratio_text(1 / draft.ratio), fastest.kernel);
            row.certainty = fmt::format("{} right", (*right)->n);
        }
        draft.question = fmt::format("{}, {}", index.task(key.first).title, key.second);
        drafts.push_back(std::move(draft));
    }
    return drafts;
}

} // namespace boxwood::bench
