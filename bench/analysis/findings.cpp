#include "bench/analysis/findings.h"

#include "bench/analysis/ladders.h"
#include "bench/analysis/rankings.h"
#include "bench/analysis/tree_rankings.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

using results::Results;

std::string witness_of(const Results& results, std::uint32_t cell_id) {
    for (const results::Check& check : results.checks)
        if (check.cell_id == cell_id && check.status == "wrong")
            return fmt::format("{} missing, {} extra; {}", check.missing, check.extra,
                               check.witness);
    return "right when checked, but a timed round answered otherwise";
}

/// Kernels are judged by what they promise, in the ladders.
bool is_judged(const Results& results, const results::Cell& cell) {
    return std::ranges::find(results.kernels, cell.cell_id, &results::KernelRow::cell_id) !=
           results.kernels.end();
}

bool is_checked_wrong(const Results& results, const results::Cell& cell) {
    return std::ranges::any_of(results.checks, [&](const results::Check& check) {
        return check.cell_id == cell.cell_id && check.status == "wrong";
    });
}

bool has_crashed(const results::Check& check) {
    return check.status == "wrong" && check.witness.starts_with("crashed: ");
}

} // namespace

std::string findings_text(const Results& results) {
    const RunIndex index(results);
    std::string text = ladders_text(results);
    bool ranked = false;
    for (const std::string& table :
         {rankings_text(index, results.compare), tree_rankings_text(index)})
        if (!table.empty()) {
            text += (text.empty() ? "" : "\n") + table;
            ranked = true;
        }
    if (ranked)
        text += "\nTimes are medians. peer/ours above 1: ours takes less time; in brackets the "
                "95 % interval of the paired ratio.\n";
    if (const auto floor = noise_floor(results))
        text += fmt::format("Noise floor (one cell timed twice per round): {:.1f} %; no smaller "
                            "difference is claimed.\n",
                            100 * *floor);
    else
        text += "Too few rounds for a noise floor and for verdicts.\n";
    const auto disturbed =
        std::ranges::count_if(results.samples, [](const results::Sample& sample) {
            return (sample.flags & results::disturbed_steal) != 0;
        });
    text += fmt::format("Samples: {}, of which {} lost time to the hypervisor.\n",
                        results.samples.size(), disturbed);
    std::string wrong;
    for (const results::Cell& cell : results.cells)
        if (index.is_wrong(cell) && !(is_judged(results, cell) && is_checked_wrong(results, cell)))
            wrong += fmt::format("  {}: {}\n", cell.name, witness_of(results, cell.cell_id));
    if (!results.kernels.empty())
        text += promises_text(results);
    if (!wrong.empty())
        text += "Wrong, recorded and not ranked:\n" + wrong;
    else if (results.kernels.size() < results.cells.size())
        text += fmt::format("Every {}timed answer agrees with the truth.\n",
                            results.kernels.empty() ? "" : "other ");
    return text;
}

bool is_promise_broken(const Results& results) {
    const RunIndex index(results);
    return std::ranges::any_of(results.cells,
                               [&](const results::Cell& cell) {
                                   return index.is_wrong(cell) && !index.variant(cell).is_peer &&
                                          !(is_judged(results, cell) &&
                                            is_checked_wrong(results, cell));
                               }) ||
           broken_promises(results) > 0 || std::ranges::any_of(results.checks, has_crashed);
}

} // namespace boxwood::bench
