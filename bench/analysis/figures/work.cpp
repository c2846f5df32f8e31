#include "bench/analysis/figures/work.h"

#include "bench/analysis/index.h"
#include "bench/analysis/job.h"
#include "bench/analysis/times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <tuple>

namespace boxwood::bench {

using results::Phase;
using results::QueryKernel;
using results::Results;
using results::WorkRow;

std::vector<QueryKernel> query_kernels_of(const Results& results) {
    const Index index(results);
    const MedianIndex medians(results);
    struct Query {
        std::uint32_t cell_id;
        std::string_view kernel;
        double ns;
    };
    using Tree = std::tuple<JobKey, std::string, std::string, std::string>; // executor, precision
    std::map<Tree, std::vector<Query>> trees;
    for (const results::Cell& cell : results.cells) {
        const results::Variant& variant = index.variant(cell);
        const double ns = medians.ns(cell.cell_id, Phase::query);
        if (variant.builder.empty() || variant.kernel.empty() || std::isnan(ns))
            continue; // a peer, or on hard cases, or no kernel
        const std::string tree =
            fmt::format("{}.{}.{}", variant.builder, variant.layout, variant.traversal);
        trees[{job_of(cell), cell.executor, cell.precision, tree}].push_back(
            {cell.cell_id, variant.kernel, ns});
    }
    std::vector<QueryKernel> all;
    std::uint32_t group = 0;
    for (auto& [tree, queries] : trees) {
        std::ranges::sort(queries, {}, &Query::ns);
        const Query& quickest = queries.front();
        if (std::ranges::all_of(queries, [&quickest](const Query& query) {
                return query.kernel == quickest.kernel;
            }))
            continue;
        for (const Query& query : queries)
            all.push_back({query.cell_id, group, std::get<3>(tree), query.ns / quickest.ns});
        ++group;
    }
    return all;
}

std::vector<WorkRow> work_of(const Results& results) {
    const MedianIndex medians(results);
    std::map<std::uint32_t, std::map<std::string, double>> counts;
    for (const results::Counter& row : results.counters)
        if (row.value > 0 && row.value != results::no_count)
            counts[row.cell_id][row.counter] = static_cast<double>(row.value);
    std::vector<WorkRow> all;
    for (const results::Cell& cell : results.cells) {
        const auto& of_cell = counts[cell.cell_id];
        const bool has_queries = cell.n_queries > 0 && cell.n_queries != results::no_count;
        const auto n = static_cast<double>(
            std::max<std::uint64_t>(1, has_queries ? cell.n_queries : cell.n_items));
        const auto each = [&](const char* counter) {
            const auto found = of_cell.find(counter);
            return found == of_cell.end() ? results::missing : found->second / n;
        };
        const WorkRow row{cell.cell_id, each("node_visits"), each("box_tests"),
                          medians.ns(cell.cell_id, Phase::query) / n};
        if (!std::isnan(row.node_visits) || !std::isnan(row.box_tests))
            all.push_back(row);
    }
    return all;
}

} // namespace boxwood::bench
