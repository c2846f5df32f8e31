#include "bench/analysis/kernel_costs.h"

#include "bench/analysis/times.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::KernelCost;
using results::KernelRow;

constexpr std::string_view whole_queries = "typical"; // a family that is none

} // namespace

std::vector<KernelCost> kernel_costs_of(const results::Results& results) {
    std::map<std::uint32_t, const results::Cell*> cells;
    for (const results::Cell& cell : results.cells)
        cells[cell.cell_id] = &cell;
    std::map<std::uint32_t, const results::Variant*> variants;
    for (const results::Variant& variant : results.variants)
        variants[variant.variant_id] = &variant;
    const MedianIndex medians(results);

    using Key = std::tuple<std::string, std::string, bool, std::string, std::string>;
    std::map<Key, std::pair<KernelCost, int>> costs; // and the number of families
    for (const KernelRow& row : results.kernels) {
        if (row.family == whole_queries || row.n == 0 || row.status == results::Status::unsupported)
            continue;
        const results::Cell& cell = *cells.at(row.cell_id);
        const results::Variant& variant = *variants.at(cell.variant_id);
        const bool is_peer = variant.is_peer != 0;
        const std::string label = is_peer && cell.precision != "f64" &&
                                          row.kernel.find(cell.precision) == std::string::npos
                                      ? row.kernel + " " + cell.precision
                                      : row.kernel;
        const double swept = medians.ns(row.cell_id, results::Phase::query);
        const double ns = std::isnan(swept) ? row.ns_per_call : swept / static_cast<double>(row.n);
        if (std::isnan(ns))
            continue;
        auto& [cost, families] = costs[{row.task, row.panel, is_peer, variant.library, label}];
        if (families++ == 0)
            cost = {row.task, row.panel, label, variant.library, row.promise, is_peer, 0};
        cost.ns += ns;
        cost.n += row.n;
        cost.wrong += row.false_pos + row.false_neg + row.bound_violations;
        cost.maybe += row.maybe;
        cost.max_rel_err = std::fmax(cost.max_rel_err, row.max_rel_err);
    }
    std::vector<KernelCost> all;
    for (auto& [key, sum] : costs) {
        sum.first.ns /= sum.second;
        all.push_back(std::move(sum.first));
    }
    std::ranges::stable_sort(all, {}, [](const KernelCost& cost) {
        return std::tuple(cost.task, cost.panel, cost.is_peer, cost.ns);
    });
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
