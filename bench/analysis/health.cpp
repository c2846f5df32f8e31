#include "bench/analysis/health.h"

#include "bench/analysis/index.h"
#include "bench/analysis/promises.h"
#include "bench/analysis/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace boxwood::bench {
namespace {

using results::Health;
using results::Results;
using results::Status;

struct Counted {
    std::string first_wrong;      ///< name of the first of ours that is to blame
    std::uint64_t unpromised = 0; ///< of ours, wrong where no promise covers it
};

Counted count_answers(const Results& results, Health& health) {
    const Index index(results);
    std::set<std::uint32_t> broken;
    for (const results::KernelRow& row : results.kernels)
        if (row.is_broken)
            broken.insert(row.cell_id);
    Counted counted;
    for (const results::Cell& cell : results.cells) {
        const bool is_wrong = cell.status == Status::wrong;
        const bool is_peer = index.is_peer(cell);
        if (cell.status == Status::unchecked || cell.status == Status::unsupported)
            continue;
        ++health.answers;
        if (is_wrong && is_peer)
            ++health.wrong_peers;
        else if (is_wrong && is_judged_by_promise(results, cell) && !broken.contains(cell.cell_id))
            ++counted.unpromised;
        else if (is_wrong && ++health.wrong_ours == 1)
            counted.first_wrong = cell.name;
    }
    return counted;
}

/// Of the cell that was timed in the most of them.
std::uint64_t max_rounds(const Results& results) {
    std::map<std::pair<std::uint32_t, results::Phase>, std::uint64_t> rounds;
    std::uint64_t highest = 0;
    for (const results::Sample& sample : results.samples)
        if ((sample.flags & results::aa_twin) == 0)
            highest = std::max(highest, ++rounds[{sample.cell_id, sample.phase}]);
    return highest;
}

/// lowest: of the noise floors; busy: rounds that began while others worked.
std::string trust_text(const Health& health, double lowest, std::ptrdiff_t busy) {
    if (health.samples == 0)
        return "";
    std::string text = fmt::format(
        "{} round{}{}, {:.1f} % of the samples disturbed; ", health.rounds,
        health.rounds == 1 ? "" : "s",
        busy > 0 ? fmt::format(" ({} began beside other programs)", busy) : "",
        100 * static_cast<double>(health.disturbed) / static_cast<double>(health.samples));
    if (std::isnan(health.floor))
        text += "noise floor not known";
    else if (lowest < health.floor)
        text += fmt::format(
            "noise floor {:.1f} to {:.1f} % by threads, length, and whether something is built",
            100 * lowest, 100 * health.floor);
    else
        text += fmt::format("noise floor {:.1f} %", 100 * health.floor);
    if (health.is_too_noisy)
        return text + ": too noisy";
    if (health.rounds < min_pairs_verdict)
        return text + fmt::format(": verdicts need at least {} rounds", min_pairs_verdict);
    if (std::isnan(health.floor))
        return text + ": no cell was timed twice";
    const bool is_quiet = lowest <= noisy_floor && 2 * health.disturbed <= health.samples;
    return text + (!is_quiet ? ": not quiet; what differs by less than its floor is left open"
                   : health.floor > noisy_floor
                       ? ": quiet enough in part; what differs by less than its floor is left open"
                       : ": quiet enough");
}

/// Names the first of our wrong answers, and the kernels that break a promise, the first ones at
/// least.
std::string correctness_text(const Results& results, const Health& health, const Counted& counted) {
    constexpr std::uint64_t max_named = 2;
    std::string text = fmt::format(
        "{} answers checked: {} of ours wrong{}{}, {} of the peers' wrong", health.answers,
        health.wrong_ours,
        counted.unpromised
            ? fmt::format(" against a promise and {} that none covers", counted.unpromised)
            : "",
        counted.first_wrong.empty() ? "" : " (" + counted.first_wrong + ")", health.wrong_peers);
    std::uint64_t named = 0;
    for (const results::KernelRow& row : results.kernels)
        if (row.is_broken && named++ < max_named)
            text += fmt::format("{} {} on {}", named == 1 ? "; PROMISE BROKEN:" : ",", row.kernel,
                                row.family);
    return named > max_named ? text + fmt::format(" and {} more", named - max_named) : text;
}

} // namespace

Health health_of(const Results& results, const NoiseFloors& floors, double delta) {
    Health health;
    health.rounds = max_rounds(results);
    health.samples = results.samples.size();
    health.disturbed = static_cast<std::uint64_t>(
        std::ranges::count_if(results.samples, [](const results::Sample& sample) {
            return (sample.flags & (results::disturbed_steal | results::disturbed_switches)) != 0;
        }));
    health.floor = floors.highest().value_or(results::missing);
    health.delta = delta;
    const double lowest = floors.lowest().value_or(0);
    health.is_too_noisy = lowest > max_floor;
    const Counted counted = count_answers(results, health);
    health.broken_promises = broken_promises(results);
    health.trust =
        trust_text(health, lowest, std::ranges::count_if(results.shards, [](const auto& shard) {
                       return shard.other_cores > results::quiet_cores;
                   }));
    health.correctness = correctness_text(results, health, counted);
    if (health.is_too_noisy)
        health.advice = fmt::format("REPEAT THIS: the same work timed twice differed by more than "
                                    "{:.0f} %, so no time here means anything. Close other "
                                    "programs (`boxwood doctor` says which settings disturb) and "
                                    "measure again.",
                                    100 * max_floor);
    return health;
}

} // namespace boxwood::bench
