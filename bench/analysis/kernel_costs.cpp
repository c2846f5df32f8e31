#include "bench/analysis/kernel_costs.h"

#include "bench/analysis/figures/kernel_rows.h"
#include "bench/analysis/index.h"
#include "bench/io/text_table.h"
#include "scenes/hard_cases/hard_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::KernelCost;
using results::KernelRow;

double badness_of(const KernelCost& cost) {
    if (!cost.by_error)
        return cost.wrong_per_million;
    return cost.max_rel_err > 1         ? std::numeric_limits<double>::infinity()
           : cost.max_rel_err > 0x1p-53 ? cost.max_rel_err
                                        : 0;
}

/// Rates, and who is on the front; the rows of one panel are in order of time, ours first.
void set_rates_and_front(std::vector<KernelCost>& costs, const std::set<std::string>& by_error) {
    const KernelCost* best = nullptr;
    for (KernelCost& cost : costs) {
        const auto n = static_cast<double>(cost.n);
        cost.wrong_per_million = 1e6 * static_cast<double>(cost.wrong) / n;
        cost.by_error = by_error.contains(cost.task);
        if (!cost.by_error && cost.wrong == 0)
            cost.unexcluded_per_million = std::min(3e6 / n, 1e6);
        cost.badness = badness_of(cost);
        if (best && (best->task != cost.task || best->panel != cost.panel))
            best = nullptr;
        cost.on_front = !cost.is_peer && cost.maybe == 0 && (!best || cost.badness < best->badness);
        if (cost.on_front)
            best = &cost;
    }
}

} // namespace

std::vector<KernelCost> kernel_costs_of(const results::Results& results) {
    const Index index(results);
    std::set<std::uint32_t> with_conditions; // distances: a false yes or no has none
    for (const results::ConditionRow& row : results.conditions)
        with_conditions.insert(row.cell_id);
    std::set<std::string> by_error; // tasks

    using Key = std::tuple<std::string, std::string, bool, std::string, std::string>;
    std::map<Key, std::pair<KernelCost, int>> costs; // and the number of families
    for (const KernelRow& row : results.kernels) {
        if (with_conditions.contains(row.cell_id))
            by_error.insert(row.task);
        if (!is_judged(row) || std::isnan(row.ns))
            continue;
        const results::Variant& variant = index.variant(index.cell(row.cell_id));
        const bool is_peer = variant.is_peer != 0;
        auto& [cost, families] = costs[{row.task, row.panel, is_peer, variant.library, row.label}];
        if (families++ == 0)
            cost = {row.task, row.panel, row.label, variant.library, row.promise, is_peer, 0};
        cost.ns += row.ns;
        cost.n += row.n;
        cost.wrong += row.wrong;
        cost.maybe += row.maybe;
        cost.max_rel_err = std::fmax(cost.max_rel_err, row.max_rel_err);
    }
    std::vector<KernelCost> all;
    for (auto& [key, sum] : costs) {
        sum.first.ns /= sum.second;
        all.push_back(std::move(sum.first));
    }
    std::ranges::stable_sort(all, {}, [](const KernelCost& cost) {
        const auto* panel =
            std::ranges::find(all_panels, cost.panel, [](Panel p) { return to_string(p); });
        return std::tuple(cost.task, panel, cost.is_peer, cost.ns);
    });
    set_rates_and_front(all, by_error);
    return all;
}

std::string kernel_costs_text(const results::Results& results) {
    TextTable table({"kernels", "input", "kernel", "promise", ">calls", ">wrong", ">undecided",
                     ">worst rel. error", ">a call"});
    for (const KernelCost& cost : results.kernel_costs)
        table.add({cost.task, cost.panel, cost.kernel, cost.is_peer ? "peer" : cost.promise,
                   std::to_string(cost.n), std::to_string(cost.wrong), std::to_string(cost.maybe),
                   std::isnan(cost.max_rel_err) ? "-" : fmt::format("{:.2g}", cost.max_rel_err),
                   time_text(cost.ns)});
    return table.empty() ? "" : table.text();
}

} // namespace boxwood::bench
