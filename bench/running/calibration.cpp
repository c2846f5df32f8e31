#include "bench/running/calibration.h"

#include "bench/machine/caches.h"
#include "bench/machine/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace boxwood::bench {
namespace {

constexpr std::string_view header = "build_iterations\tquery_iterations\tbuild_ns\tquery_ns\tcell";

/// Beside the timed loops and their warm-up: contender, answers, hash.
constexpr double set_up_s = 1e-3;

/// The caches are flushed before each query.
double flushes_s(const PlannedCell& cell) {
    static const double flush_s = CacheFlush::guessed_s(read_machine(""));
    return cell.cold_caches ? static_cast<double>(cell.scene.n_poses) * flush_s : 0;
}

} // namespace

std::uint64_t iterations_for(double target_ns, double ns) {
    constexpr double max_iterations = 1e7;
    if (!(ns > 0))
        return static_cast<std::uint64_t>(max_iterations);
    return static_cast<std::uint64_t>(std::clamp(std::ceil(target_ns / ns), 1.0, max_iterations));
}

double round_ns(const Calibration& c) {
    return c.build_ns * static_cast<double>(c.build_iterations + 1) +
           c.query_ns * static_cast<double>(c.query_iterations + 1);
}

std::string to_text(const Calibrations& calibrations) {
    std::string text = fmt::format("{}\n", header);
    for (const auto& [name, c] : calibrations)
        text += fmt::format("{}\t{}\t{}\t{}\t{}\n", c.build_iterations, c.query_iterations,
                            c.build_ns, c.query_ns, name);
    return text;
}

Calibrations calibrations_of(std::string_view text) {
    std::istringstream lines{std::string(text)};
    std::string line;
    if (!std::getline(lines, line) || line != header)
        throw std::runtime_error("the text \"calibration\" is not the table it should be");
    Calibrations calibrations;
    while (std::getline(lines, line)) {
        std::istringstream fields(line);
        Calibration c;
        std::string name;
        if (!(fields >> c.build_iterations >> c.query_iterations >> c.build_ns >> c.query_ns >>
              name))
            throw std::runtime_error("the text \"calibration\" has a bad line: " + line);
        calibrations.emplace(name, c);
    }
    return calibrations;
}

double cell_s(const PlannedCell& cell, const Calibration& calibration) {
    return round_ns(calibration) * 1e-9 + set_up_s + flushes_s(cell);
}

double guessed_cell_s(const PlannedCell& cell, double min_time_ms) {
    const double call =
        1e-6 * static_cast<double>(cell.scene.n + cell.scene.n_rays + cell.scene.n_points);
    return 2 * (call + std::max(call, min_time_ms * 1e-3)) + set_up_s + flushes_s(cell);
}

std::set<std::string> choose_twins(const results::Results& prepared,
                                   const Calibrations& calibrations,
                                   const std::set<std::string>& in_fewer_rounds,
                                   const std::set<std::string>& with_cold_caches) {
    std::map<std::uint32_t, bool> wrong, peer;
    for (const results::Check& check : prepared.checks)
        wrong[check.cell_id] |= check.status == results::Status::wrong;
    for (const results::Variant& variant : prepared.variants)
        peer[variant.variant_id] = variant.is_peer != 0;

    double all_ns = 0;
    using Kind = std::tuple<bool, bool, bool, bool>; // a peer's, several threads, brief, cold
    using Cost = std::tuple<bool, bool, double, std::string>; // wrong, fewer rounds, ns, name
    std::map<Kind, std::vector<Cost>> kinds;
    for (const results::Cell& cell : prepared.cells) {
        const auto found = calibrations.find(cell.name);
        if (found == calibrations.end())
            continue;
        const Calibration& c = found->second;
        all_ns += round_ns(c);
        const bool is_peer = peer[cell.variant_id];
        const Kind kind =
            is_peer ? Kind{true, false, false, false}
                    : Kind{false, cell.threads > 1, std::max(c.build_ns, c.query_ns) < 1e6,
                           with_cold_caches.contains(cell.name)};
        kinds[kind].emplace_back(wrong[cell.cell_id], in_fewer_rounds.contains(cell.name),
                                 round_ns(c), cell.name);
    }
    std::vector<Cost> first, more;
    for (auto& [kind, costs] : kinds) {
        std::ranges::sort(costs);
        first.push_back(costs.front());
        for (const std::size_t place : {costs.size() / 4, costs.size() / 2})
            more.push_back(costs[place]);
    }
    std::ranges::sort(first);
    std::ranges::sort(more);
    std::set<std::string> names;
    for (const auto& [is_wrong, is_rare, ns, name] : first)
        if (names.empty() || (!is_wrong && ns < all_ns / 10))
            names.insert(name);
    double more_ns = 0;
    for (const auto& [is_wrong, is_rare, ns, name] : more)
        if (!is_wrong && !is_rare && more_ns + ns < all_ns / 10 && names.insert(name).second)
            more_ns += ns;
    return names;
}

} // namespace boxwood::bench
