#include "bench/commands/show.h"

#include "bench/analysis/compare.h"
#include "bench/analysis/ladders.h"
#include "bench/analysis/limits.h"
#include "bench/analysis/run_index.h"
#include "bench/analysis/sections.h"
#include "bench/commands/command.h"
#include "bench/io/text_table.h"
#include "bench/tasks/task.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::Check;
using results::Comparison;
using results::Results;

std::string bytes_text(std::uint64_t bytes) {
    return bytes == results::no_count ? "?"
           : bytes < (1u << 20)       ? fmt::format("{} KiB", bytes >> 10)
                                      : fmt::format("{} MiB", bytes >> 20);
}

std::string or_unknown(const std::string& text) { return text.empty() ? "?" : text; }

std::string machine_text(const results::Env& env, std::size_t rounds) {
    std::string text =
        fmt::format("machine {}: {}, {} processors, L1d {}, L2 {}, L3 {}, {} rounds\n",
                    or_unknown(env.host), or_unknown(env.cpu), env.ncpu, bytes_text(env.l1d_bytes),
                    bytes_text(env.l2_bytes), bytes_text(env.l3_bytes), rounds);
    text += fmt::format("  instruction set {} (of {}), governor {}, huge pages {}, virtual machine "
                        "{}, kernel {}\n",
                        or_unknown(env.isa_used), or_unknown(env.isa_max), or_unknown(env.governor),
                        or_unknown(env.thp), or_unknown(env.virt), or_unknown(env.kernel));
    if (!std::isnan(env.stream_triad_gbs_1))
        text += fmt::format("  memory bandwidth (triad) {:.1f} GB/s with one thread, {:.1f} GB/s "
                            "with all; clock {:.2f} GHz\n",
                            env.stream_triad_gbs_1, env.stream_triad_gbs_all, env.core_ghz);
    text += fmt::format("  built by {} {} ({}), commit {}{}, seed {}\n", or_unknown(env.compiler),
                        env.flags, or_unknown(env.build_type), or_unknown(env.git_commit),
                        env.git_dirty ? " with changes" : "", env.seed);
    const std::pair<const char*, const std::string*> packages[] = {
        {"Embree", &env.embree_version},   {"FCL", &env.fcl_version},
        {"CGAL", &env.cgal_version},       {"Bullet", &env.bullet_version},
        {"TBB", &env.tbb_version},         {"Eigen", &env.eigen_version},
        {"HDF5", &env.hdf5_version},       {"benchmark", &env.gbench_version},
        {"Highway", &env.highway_version},
    };
    std::string versions;
    for (const auto& [name, version] : packages)
        versions += fmt::format("{}{} {}", versions.empty() ? "" : ", ", name,
                                version->empty() ? "absent" : *version);
    return text + "  " + versions + "\n";
}

std::string header_text(const Results& results) {
    std::map<std::uint32_t, std::set<std::uint32_t>> rounds_on;
    for (const auto& shard : results.shards)
        rounds_on[shard.env_id].insert(shard.round);
    std::map<std::uint32_t, std::size_t> flags;
    for (const auto& sample : results.samples)
        for (const std::uint32_t flag : {1u, 2u, 4u, 8u})
            flags[flag] += (sample.flags & flag) != 0;

    std::string text =
        fmt::format("run {}, {}, by {}, sweep {}, {}\n", or_unknown(results.run_uuid),
                    or_unknown(results.created_utc), or_unknown(results.generator),
                    or_unknown(results.sweep_hash), results.complete ? "complete" : "incomplete");
    for (const auto& env : results.env)
        text += machine_text(env, rounds_on[env.env_id].size());
    text += fmt::format("{} cells, {} samples in {} shards; of the samples {} lost time to the "
                        "hypervisor, {} were switched out, {} gave another answer\n",
                        results.cells.size(), results.samples.size(), results.shards.size(),
                        flags[results::disturbed_steal], flags[results::disturbed_switches],
                        flags[results::wrong_answer]);
    if (const auto floor = noise_floor(results))
        text += fmt::format("A/A noise floor +-{:.1f} %: no difference below it is claimed\n",
                            100 * *floor);
    else
        text += flags[results::aa_twin] > 0
                    ? fmt::format("A/A noise floor not known: it takes {} rounds\n",
                                  least_pairs_interval)
                    : "A/A noise floor not known: no cell was timed twice\n";
    return text;
}

std::string scenes_text(const Results& results) {
    TextTable table({"scene", ">items", ">triangles", ">seed", ">content hash"});
    for (const auto& scene : results.scenes)
        table.add({scene.name, std::to_string(scene.n_items), std::to_string(scene.n_triangles),
                   std::to_string(scene.seed), fmt::format("{:016x}", scene.content_hash)});
    return table.empty() ? "" : "\n" + table.text();
}

/// The cells that do the same work, and what is known of them.
class Group {
  public:
    Group(const Results& results, const std::vector<CellStats>& stats,
          const std::vector<Comparison>& comparisons, std::vector<const Cell*> cells)
        : results_(results), comparisons_(comparisons), cells_(std::move(cells)) {
        for (const auto& variant : results.variants)
            variants_[variant.variant_id] = &variant;
        for (const Cell* cell : cells_)
            labels_[cell->cell_id] = label_of(*cell);
        for (const CellStats& row : stats)
            if (labels_.contains(row.cell_id))
                stats_[row.cell_id][row.phase] = row;
        for (const Check& check : results.checks)
            if (labels_.contains(check.cell_id))
                checks_[check.cell_id].push_back(&check);
    }
    std::string text() const {
        return title() + times() + failures() + work() + limits() + verdicts();
    }

  private:
    std::string label_of(const Cell& cell) const {
        const auto variant = variants_.find(cell.variant_id);
        const std::string& name = variant == variants_.end() ? cell.name : variant->second->name;
        std::string label = fmt::format("{} {} {}", name, cell.precision, cell.executor);
        if (!cell.isa.empty())
            label += " " + cell.isa;
        return label;
    }

    std::string title() const {
        const Cell& cell = *cells_.front();
        std::string scene = fmt::format("scene {}", cell.scene_id);
        for (const auto& row : results_.scenes)
            if (row.scene_id == cell.scene_id)
                scene = fmt::format("{}, {} items", row.name, row.n_items);
        return fmt::format("\n{}, {}, {} thread{}\n", scene, cell.task, cell.threads,
                           cell.threads == 1 ? "" : "s");
    }

    std::string status_of(std::uint32_t cell) const {
        const auto found = checks_.find(cell);
        if (found == checks_.end())
            return "unchecked";
        std::string text;
        for (const Check* check : found->second)
            text += (text.empty() ? "" : ", ") + check->status;
        return text;
    }

    std::string times() const {
        std::set<std::string> phases;
        for (const auto& [cell, by_phase] : stats_)
            for (const auto& [phase, row] : by_phase)
                phases.insert(phase);
        std::vector<std::string> headings{"  cell", "check", ">rounds"};
        for (const std::string& phase : phases)
            for (const std::string& heading :
                 {phase + " median", std::string("MAD"), std::string("min"), std::string("p95"),
                  std::string("p99")})
                headings.push_back(">" + heading);
        TextTable table(headings);
        for (const Cell* cell : cells_) {
            std::vector<std::string> row{"  " + labels_.at(cell->cell_id), status_of(cell->cell_id),
                                         "0"};
            const auto timed = stats_.find(cell->cell_id);
            for (const std::string& phase : phases) {
                CellStats stats;
                if (timed != stats_.end() && timed->second.contains(phase))
                    stats = timed->second.at(phase);
                row[2] = std::to_string(std::max<std::size_t>(stats.n, std::stoul(row[2])));
                for (const double ns :
                     {stats.median_ns, stats.mad_ns, stats.min_ns, stats.p95_ns, stats.p99_ns})
                    row.push_back(time_text(ns));
            }
            table.add(std::move(row));
        }
        return table.text();
    }

    /// What is wrong or unsupported, with the witness or the reason.
    std::string failures() const {
        std::string text;
        for (const Cell* cell : cells_)
            if (const auto found = checks_.find(cell->cell_id); found != checks_.end())
                for (const Check* check : found->second) {
                    const std::string& label = labels_.at(cell->cell_id);
                    if (check->status == "wrong")
                        text += fmt::format("  wrong, not ranked: {}: {} missing and {} extra of "
                                            "{}; {}\n",
                                            label, check->missing, check->extra, check->n_expected,
                                            check->witness);
                    else if (check->status == "unsupported")
                        text += fmt::format("  unsupported: {}: {}\n", label, check->witness);
                }
        return text;
    }

    std::string work() const {
        std::vector<std::string> names;
        std::map<std::uint32_t, std::map<std::string, std::uint64_t>> values;
        for (const auto& row : results_.counters)
            if (labels_.contains(row.cell_id)) {
                values[row.cell_id][row.counter] = row.value;
                if (std::ranges::count(names, row.counter) == 0)
                    names.push_back(row.counter);
            }
        std::vector<std::string> headings{"  work of one query"};
        for (const std::string& name : names)
            headings.push_back(">" + name);
        TextTable table(headings);
        for (const Cell* cell : cells_) {
            if (!values.contains(cell->cell_id))
                continue;
            std::vector<std::string> row{"  " + labels_.at(cell->cell_id)};
            for (const std::string& name : names)
                row.push_back(values[cell->cell_id].contains(name)
                                  ? std::to_string(values[cell->cell_id][name])
                                  : "-");
            table.add(std::move(row));
        }
        return table.empty() ? "" : table.text();
    }

    /// How many times the least time that the machine could take.
    std::string limits() const {
        TextTable table({"  times the machine's limit", ">build", ">update", ">query"});
        for (const Cell* cell : cells_) {
            if (variants_.contains(cell->variant_id) && variants_.at(cell->variant_id)->is_peer)
                continue;
            std::vector<std::string> row{"  " + labels_.at(cell->cell_id)};
            bool known = false;
            for (const char* phase : {"build", "update", "query"}) {
                const auto timed = stats_.find(cell->cell_id);
                const double limit = limit_ns(results_, *cell, phase);
                const bool has =
                    timed != stats_.end() && timed->second.contains(phase) && !std::isnan(limit);
                row.push_back(has ? ratio_text(timed->second.at(phase).median_ns / limit) : "-");
                known |= has;
            }
            if (known)
                table.add(std::move(row));
        }
        return table.empty() ? "" : table.text();
    }

    /// One row for each of ours and each peer, with the ratio of every phase.
    std::string verdicts() const {
        std::vector<std::string> phases;
        for (const char* phase : {"build", "update", "query", "build+query", "update+query"})
            if (std::ranges::any_of(comparisons_, [&](const auto& row) {
                    return row.phase == phase && labels_.contains(row.cell_b);
                }))
                phases.push_back(phase);
        if (std::ranges::count(phases, "update+query") > 0)
            std::erase(phases, "build+query"); // frames follow the build, not one query
        std::vector<std::string> headings{"  ours", "peer", ">rounds"};
        for (const std::string& phase : phases)
            headings.push_back(phase + ", peer/ours");
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::map<std::string, Comparison>> rows;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
        for (const Comparison& row : comparisons_)
            if (labels_.contains(row.cell_a) && labels_.contains(row.cell_b)) {
                auto& by_phase = rows[{row.cell_b, row.cell_a}];
                if (by_phase.empty())
                    order.emplace_back(row.cell_b, row.cell_a);
                by_phase[row.phase] = row;
            }
        TextTable table(headings);
        for (const auto& key : order) {
            auto& by_phase = rows[key];
            std::size_t rounds = 0;
            for (const auto& [phase, row] : by_phase)
                rounds = std::max<std::size_t>(rounds, row.n_pairs);
            std::vector<std::string> row{"  " + labels_.at(key.first), labels_.at(key.second),
                                         std::to_string(rounds)};
            for (const std::string& phase : phases)
                row.push_back(by_phase.contains(phase) ? comparison_text(by_phase[phase]) : "-");
            table.add(std::move(row));
        }
        return table.empty() ? "" : table.text();
    }

    static std::string comparison_text(const Comparison& row) {
        if (row.verdict == "wrong")
            return verdict_text(row.verdict);
        return interval_text(1 / row.ratio, 1 / row.ci_hi, 1 / row.ci_lo) + " " +
               verdict_text(row.verdict);
    }

    const Results& results_;
    const std::vector<Comparison>& comparisons_;
    std::vector<const Cell*> cells_;
    std::map<std::uint32_t, const results::Variant*> variants_;
    std::map<std::uint32_t, std::string> labels_;
    std::map<std::uint32_t, std::map<std::string, CellStats>> stats_;
    std::map<std::uint32_t, std::vector<const Check*>> checks_;
};

/// Why so many verdicts are open, if they are.
std::string advice_text(const std::vector<Comparison>& comparisons) {
    std::size_t open = 0, short_of = 0;
    for (const auto& row : comparisons)
        if (row.verdict == "cannot_tell") {
            ++open;
            short_of += row.n_pairs < least_pairs_verdict;
        }
    std::string text = "\npeer/ours above 1: ours takes less time; medians of paired rounds, p "
                       "corrected (Holm) over the peers of a cell.\n";
    if (short_of > 0)
        text += fmt::format("{} of {} comparisons have fewer than {} rounds, too few for a "
                            "verdict: run the sweep with --rounds {} or more.\n",
                            short_of, comparisons.size(), least_pairs_verdict, least_pairs_verdict);
    else if (open > 0)
        text += fmt::format("{} of {} comparisons cannot be told: more rounds narrow the "
                            "intervals.\n",
                            open, comparisons.size());
    return text;
}

} // namespace

std::string show_text(const Results& results, bool with_kernels, bool brief) {
    std::string text = header_text(results);
    const auto comparisons = compare_to_peers(results);
    const auto advice = [&] { return comparisons.empty() ? "" : advice_text(comparisons); };
    if (brief)
        return text + sections_text(results, comparisons, brief) + advice();
    text += scenes_text(results);
    if (!results.kernels.empty())
        text += "\n" + ladders_text(results) + "\n" + promises_text(results);
    using Work = std::tuple<std::uint32_t, std::string, std::uint32_t>;
    std::map<Work, std::vector<const Cell*>> groups;
    std::vector<Work> order;
    std::size_t passed_over = 0;
    for (const Cell& cell : results.cells) {
        const Task* task = find_task(cell.task);
        if (task && task->scenes() == SceneKind::cases && !with_kernels) {
            ++passed_over; // summed up in the ladders
            continue;
        }
        const Work work{cell.scene_id, cell.task, cell.threads};
        if (!groups.contains(work))
            order.push_back(work);
        groups[work].push_back(&cell);
    }
    const auto stats = cell_stats(results);
    for (const Work& work : order)
        text += Group(results, stats, comparisons, groups[work]).text();
    if (passed_over > 0)
        text += fmt::format("\n{} cells of kernels are summed up above; --kernels prints each.\n",
                            passed_over);
    return text + sections_text(results, comparisons, brief) + advice();
}

void add_show(CLI::App& app, int&) {
    auto file = std::make_shared<std::string>();
    auto with_kernels = std::make_shared<bool>(false);
    CLI::App* show = app.add_subcommand(
        "show", "what is in a result file: machine, cells, times, checks, verdicts");
    show->add_option("file", *file, "a result file (HDF5)")->required();
    show->add_flag("--kernels", *with_kernels, "each cell of a kernel, not only their sums");
    auto brief = std::make_shared<bool>(false);
    show->add_flag("--brief", *brief, "what the cells come to, without the cells");
    show->footer("Example: boxwood show quick.h5");
    show->callback([file, with_kernels, brief] {
        const Results results = results::read(*file);
        std::cout << *file << ": " << show_text(results, *with_kernels, *brief);
    });
}

} // namespace boxwood::bench
