#include "bench/analysis/figures/work.h"

#include "bench/analysis/times.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>

namespace boxwood::bench {

using results::Phase;
using results::QueryKernel;
using results::Results;
using results::WorkRow;

std::vector<QueryKernel> query_kernels_of(const Results& results) {
    std::map<std::uint32_t, const results::Variant*> variants;
    for (const results::Variant& variant : results.variants)
        variants[variant.variant_id] = &variant;
    const MedianIndex medians(results);
    using Tree = std::tuple<std::uint32_t, std::uint64_t, std::string, std::uint32_t, std::string,
                            std::string, std::string>;
    struct Query {
        std::uint32_t cell_id;
        std::string kernel;
        double ns;
    };
    std::map<Tree, std::vector<Query>> trees;
    for (const results::Cell& cell : results.cells) {
        const results::Variant& variant = *variants.at(cell.variant_id);
        const double ns = medians.ns(cell.cell_id, Phase::query);
        std::string tree = variant.name;
        const std::size_t at = tree.find("." + variant.kernel);
        if (variant.is_peer || variant.kernel.empty() || at == std::string::npos || std::isnan(ns))
            continue; // a kernel on hard cases bears its own name
        tree.erase(at, 1 + variant.kernel.size());
        trees[{cell.scene_id, cell.n_items, cell.task, cell.threads, cell.executor, cell.precision,
               tree}]
            .push_back({cell.cell_id, variant.kernel, ns});
    }
    std::vector<QueryKernel> all;
    for (const auto& [tree, queries] : trees) {
        std::set<std::string> kernels;
        for (const Query& query : queries)
            kernels.insert(query.kernel);
        const double fastest = std::ranges::min(queries, {}, &Query::ns).ns;
        for (const Query& query : queries)
            if (kernels.size() > 1)
                all.push_back({query.cell_id, query.ns / fastest});
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
