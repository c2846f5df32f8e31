#include "bench/analysis/growth.h"

#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <vector>

namespace boxwood::bench {
namespace {

using results::Cell;
using Rounds = RoundTimes::Rounds;

std::string exponent_text(const Growth& growth) {
    if (std::isnan(growth.exponent.mid))
        return "-";
    if (std::isnan(growth.exponent.lo))
        return fmt::format("{:.2f}", growth.exponent.mid);
    return fmt::format("{:.2f} [{:.2f}, {:.2f}]", growth.exponent.mid, growth.exponent.lo,
                       growth.exponent.hi);
}

/// A round's first time; a merged file may have several of one number.
double first_ns(const Rounds& rounds, const RoundTimes::RoundKey& key) {
    return rounds.at(key).front();
}

} // namespace

Growth growth_of(const std::map<double, const Rounds*>& times_by_n) {
    std::vector<double> log_n, log_median, slopes;
    for (const auto& [n, rounds] : times_by_n) {
        log_n.push_back(std::log(n));
        std::vector<double> ns;
        for (const auto& [key, values] : *rounds)
            ns.insert(ns.end(), values.begin(), values.end());
        log_median.push_back(std::log(median_interval(std::move(ns)).mid));
    }
    for (const auto& [key, values] : *times_by_n.begin()->second) {
        std::vector<double> log_ns;
        for (const auto& [n, rounds] : times_by_n)
            if (rounds->contains(key))
                log_ns.push_back(std::log(first_ns(*rounds, key)));
        if (log_ns.size() == log_n.size())
            slopes.push_back(fitted_line(log_n, log_ns).slope);
    }
    Growth growth{median_interval(std::move(slopes)), 0};
    const Line line = fitted_line(log_n, log_median);
    for (std::size_t i = 0; i < log_n.size(); ++i)
        growth.off = std::max(
            growth.off, std::expm1(std::abs(log_median[i] - line.at_0 - line.slope * log_n[i])));
    return growth;
}

std::string growth_text(const RunIndex& index) {
    // Scene, ask, threads, variant, executor, precision; then the cell of each size.
    using Key = std::tuple<std::string, std::string, std::uint32_t, std::uint32_t, std::string,
                           std::string>;
    std::map<Key, std::map<double, const Cell*>> lines;
    std::vector<Key> order;
    for (const Cell& cell : index.results().cells) {
        if (!index.is_right(cell))
            continue;
        const results::SceneRow& scene = index.scene(cell);
        const Key key{fmt::format("{} {}", scene.name, scene.seed),
                      cell.task,
                      cell.threads,
                      cell.variant_id,
                      cell.executor,
                      cell.precision};
        if (!lines.contains(key))
            order.push_back(key);
        lines[key][static_cast<double>(cell.n_items)] = &cell;
    }
    std::vector<std::string> phases;
    for (const char* phase : {"build", "update", "query", "update+query"})
        if (std::ranges::any_of(index.results().cells, [&](const Cell& cell) {
                return index.times().rounds(cell.cell_id, phase) != nullptr;
            }))
            phases.emplace_back(phase);
    std::vector<std::string> headings{"scene", "task", ">threads", "contender", ">n from", ">to"};
    for (const std::string& phase : phases) {
        headings.push_back(fmt::format(">{} ~ n^", phase));
        headings.push_back(">off by");
    }
    TextTable table(headings);
    for (const Key& key : order) {
        const auto& line = lines.at(key);
        if (line.size() < least_sizes)
            continue;
        const Cell& cell = *line.begin()->second;
        std::vector<std::string> row{
            index.scene(cell).name,       cell.task,
            std::to_string(cell.threads), index.variant(cell).name,
            std::to_string(cell.n_items), std::to_string(line.rbegin()->second->n_items)};
        for (const std::string& phase : phases) {
            std::map<double, const Rounds*> times;
            for (const auto& [n, at] : line)
                if (const Rounds* rounds = index.times().rounds(at->cell_id, phase))
                    times.emplace(n, rounds);
            const Growth growth = times.size() < least_sizes ? Growth{} : growth_of(times);
            row.push_back(exponent_text(growth));
            row.push_back(std::isnan(growth.off) ? "-" : fmt::format("{:.0f} %", 100 * growth.off));
        }
        table.add(std::move(row));
    }
    return table.empty() ? "" : table.text();
}

} // namespace boxwood::bench
