#include "bench/limits.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::missing;
using results::Results;

std::optional<double> counter(const Results& results, const Cell& cell, std::string_view name) {
    for (const results::Counter& row : results.counters)
        if (row.cell_id == cell.cell_id && row.counter == name && row.value != results::no_count)
            return static_cast<double>(row.value);
    return std::nullopt;
}

} // namespace

double limit_ns(const Results& results, const Cell& cell, std::string_view phase) {
    if (results.env.size() != 1)
        return missing;
    constexpr double box = 24, nodes = 64, pair = 8;
    const results::Env& env = results.env.front();
    const double n = static_cast<double>(cell.n_items);
    const double gbs = cell.threads == 1 ? env.stream_triad_gbs_1 : env.stream_triad_gbs_all;
    if (phase == "build" || phase == "update")
        return n * (box + nodes) / gbs;
    const auto tests = counter(results, cell, "box_tests"), pairs = counter(results, cell, "pairs");
    if (phase != "query" || !tests || !pairs)
        return missing;
    constexpr double cycles_per_test = 0.31;
    const double cycles = (cycles_per_test * *tests + *pairs) / cell.threads;
    return std::max((n * box + *pairs * pair) / gbs, cycles / env.core_ghz);
}

} // namespace boxwood::bench
