#include "bench/findings.h"

#include "bench/compare.h"
#include "bench/ladders.h"
#include "bench/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Results;

/// What contenders are ranked by, each by the best of its variants.
struct Measure {
    const char* name; ///< as in results::Comparison
    std::vector<const char*> phases;
};
const std::vector<Measure>& measures() {
    static const std::vector<Measure> all{{"build+query", {"build", "query"}},
                                          {"query", {"query"}},
                                          {"update+query", {"update", "query"}},
                                          {"build", {"build"}}};
    return all;
}

/// The rows that a cell refers to.
class Catalogue {
  public:
    explicit Catalogue(const Results& results) : standing_of_(standings(results)) {
        for (const auto& scene : results.scenes)
            scenes_[scene.scene_id] = &scene;
        for (const auto& variant : results.variants)
            variants_[variant.variant_id] = &variant;
        for (const CellStats& stats : cell_stats(results))
            median_of_[{stats.cell_id, stats.phase}] = stats.median_ns;
    }
    const results::SceneRow& scene(const results::Cell& cell) const {
        return *scenes_.at(cell.scene_id);
    }
    const results::Variant& variant(const results::Cell& cell) const {
        return *variants_.at(cell.variant_id);
    }
    bool is_right(const results::Cell& cell) const {
        return standing_of_.at(cell.cell_id) == Standing::right;
    }
    bool is_wrong(const results::Cell& cell) const {
        return standing_of_.at(cell.cell_id) == Standing::wrong;
    }
    /// Infinite if the phase was not timed.
    double median_ns(const results::Cell& cell, const std::string& phase) const {
        const auto found = median_of_.find({cell.cell_id, phase});
        return found == median_of_.end() ? std::numeric_limits<double>::infinity() : found->second;
    }
    double total_ns(const results::Cell& cell, const Measure& measure) const {
        double total = 0;
        for (const char* phase : measure.phases)
            total += median_ns(cell, phase);
        return total;
    }

  private:
    std::map<std::uint32_t, Standing> standing_of_;
    std::map<std::uint32_t, const results::SceneRow*> scenes_;
    std::map<std::uint32_t, const results::Variant*> variants_;
    std::map<std::pair<std::uint32_t, std::string>, double> median_of_;
};

/// What can be compared, in the order of the sweep; then the least time of each library.
using Task = std::tuple<std::uint32_t, std::string, std::uint32_t>; // scene, ask, threads
using Best = std::map<std::string, const results::Cell*>;           // by library

std::map<Task, Best> best_of(const Results& results, const Catalogue& catalogue,
                             const Measure& measure) {
    std::map<Task, Best> best;
    for (const results::Cell& cell : results.cells) {
        const double total = catalogue.total_ns(cell, measure);
        if (!catalogue.is_right(cell) || total == std::numeric_limits<double>::infinity())
            continue;
        const results::Cell*& kept =
            best[{cell.scene_id, cell.ask, cell.threads}][catalogue.variant(cell).library];
        if (!kept || total < catalogue.total_ns(*kept, measure))
            kept = &cell;
    }
    return best;
}

std::string comparison_text(const Results& results, std::uint32_t peer, std::uint32_t ours,
                            const char* phase) {
    for (const results::Comparison& row : results.compare)
        if (row.cell_a == peer && row.cell_b == ours && row.phase == phase)
            return fmt::format("{} [{}, {}] {}", ratio_text(1 / row.ratio),
                               ratio_text(1 / row.ci_hi), ratio_text(1 / row.ci_lo),
                               row.verdict == "cannot_tell" ? "can't tell" : row.verdict);
    return "-";
}

void add_rows(const Results& results, const Catalogue& catalogue, const Measure& measure,
              const Best& best, TextTable& table) {
    const auto ours = best.find("boxwood");
    for (const auto& [library, cell] : best) {
        const results::SceneRow& scene = catalogue.scene(*cell);
        std::vector<std::string> row{scene.name, std::to_string(cell->n_items), cell->ask,
                                     std::to_string(cell->threads), catalogue.variant(*cell).name};
        for (const char* phase : measure.phases)
            row.push_back(time_text(catalogue.median_ns(*cell, phase)));
        if (ours != best.end() && library != "boxwood")
            row.push_back(
                comparison_text(results, cell->cell_id, ours->second->cell_id, measure.name));
        table.add(std::move(row));
    }
}

/// A query that has no structure is no second measure, nor is a build that queries follow.
bool is_ranked(const Results& results, const Catalogue& catalogue, const Task& task,
               const Measure& measure) {
    const auto timed = [&](const char* phase) {
        return std::ranges::any_of(results.cells, [&](const results::Cell& cell) {
            return Task{cell.scene_id, cell.ask, cell.threads} == task &&
                   catalogue.median_ns(cell, phase) != std::numeric_limits<double>::infinity();
        });
    };
    const std::string_view name = measure.name;
    return name == "build" ? !timed("query") : name != "build+query" || !timed("update");
}

std::string table_text(const Results& results, const Catalogue& catalogue, const Measure& measure) {
    std::vector<std::string> headings{"scene", ">n", "ask", ">threads", "best of its library"};
    for (const char* phase : measure.phases)
        headings.push_back(std::string(">") + phase);
    headings.push_back(std::string(measure.name) + ", peer/ours");
    TextTable table(headings);
    for (const auto& [task, best] : best_of(results, catalogue, measure))
        if (is_ranked(results, catalogue, task, measure))
            add_rows(results, catalogue, measure, best, table);
    return table.empty() ? "" : table.text();
}

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
    const Catalogue catalogue(results);
    std::string text = ladders_text(results), tables;
    for (const Measure& measure : measures())
        if (const std::string table = table_text(results, catalogue, measure); !table.empty())
            tables += (tables.empty() ? "" : "\n") + table;
    if (!tables.empty())
        text += fmt::format("{}{}\nTimes are medians. peer/ours above 1: ours takes less time; in "
                            "brackets the 95 % interval of the paired ratio.\n",
                            text.empty() ? "" : "\n", tables);
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
        if (catalogue.is_wrong(cell) &&
            !(is_judged(results, cell) && is_checked_wrong(results, cell)))
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
    const Catalogue catalogue(results);
    return std::ranges::any_of(
               results.cells,
               [&](const results::Cell& cell) {
                   return catalogue.is_wrong(cell) && !catalogue.variant(cell).is_peer &&
                          !(is_judged(results, cell) && is_checked_wrong(results, cell));
               }) ||
           broken_promises(results) > 0 || std::ranges::any_of(results.checks, has_crashed);
}

} // namespace boxwood::bench
