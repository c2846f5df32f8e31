#include "bench/running/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace boxwood::bench {
namespace {

constexpr std::string_view header = "build_iterations\tquery_iterations\tbuild_ns\tquery_ns\tcell";

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

std::string choose_aa(const results::Results& prepared, const Calibrations& calibrations) {
    std::map<std::uint32_t, bool> wrong, peer;
    for (const results::Check& check : prepared.checks)
        wrong[check.cell_id] |= check.status == results::Status::wrong;
    for (const results::Variant& variant : prepared.variants)
        peer[variant.variant_id] = variant.is_peer != 0;

    // Least first: ours before peers, right before wrong, long enough before too short.
    using Rank = std::tuple<bool, bool, bool, double, std::string>;
    std::string chosen;
    Rank best;
    for (const results::Cell& cell : prepared.cells) {
        const auto found = calibrations.find(cell.name);
        if (found == calibrations.end())
            continue;
        const Calibration& c = found->second;
        const bool is_short = c.query_ns < 1e6;
        Rank rank{peer[cell.variant_id], wrong[cell.cell_id], is_short,
                  is_short ? -c.query_ns : round_ns(c), cell.name};
        if (chosen.empty() || rank < best) {
            best = std::move(rank);
            chosen = cell.name;
        }
    }
    return chosen;
}

} // namespace boxwood::bench
