#include "bench/commands/show.h"

#include "bench/analysis/index.h"
#include "bench/analysis/job.h"
#include "bench/analysis/kernel_costs.h"
#include "bench/analysis/promises.h"
#include "bench/analysis/screen.h"
#include "bench/analysis/status.h"
#include "bench/analysis/wording.h"
#include "bench/commands/command.h"
#include "bench/io/json.h"
#include "bench/io/read_results.h"
#include "bench/io/text_table.h"
#include "results/schema.h"

#include <CLI/CLI.hpp>
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
using results::Median;
using results::Phase;
using results::Results;

std::string machine_text(const Results& results, const results::Env& env, std::size_t rounds) {
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
    if (!env.gpu.empty())
        text += fmt::format("  device {}, {} multiprocessors, {}, {:.2f} GHz, driver {}\n", env.gpu,
                            env.gpu_sm, bytes_text(env.gpu_memory_bytes), env.gpu_clock_ghz,
                            or_unknown(env.gpu_driver));
    std::string versions;
    for (const results::Package& package : results.packages)
        if (package.env_id == env.env_id)
            versions += fmt::format("{}{} {}", versions.empty() ? "" : ", ", package.library,
                                    package.present ? package.version : "absent");
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
        text += machine_text(results, env, rounds_on[env.env_id].size());
    text += fmt::format("{} cells, {} samples in {} shards; of the samples {} lost time to the "
                        "hypervisor, {} were switched out, {} gave another answer\n",
                        results.cells.size(), results.samples.size(), results.shards.size(),
                        flags[results::disturbed_steal], flags[results::disturbed_switches],
                        flags[results::wrong_answer]);
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
    Group(const Index& index, std::vector<const Cell*> cells)
        : index_(index), results_(index.results()), cells_(std::move(cells)) {
        for (const Cell* cell : cells_)
            labels_[cell->cell_id] = label_of(*cell);
        for (const Median& row : results_.medians)
            if (labels_.contains(row.cell_id))
                medians_[row.cell_id].push_back(&row);
        for (const Check& check : results_.checks)
            if (labels_.contains(check.cell_id))
                checks_[check.cell_id].push_back(&check);
    }
    std::string text() const { return title() + times() + failures() + work() + comparisons(); }

  private:
    std::string label_of(const Cell& cell) const {
        std::string label =
            fmt::format("{} {} {}", index_.variant(cell).name, cell.precision, cell.executor);
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
        const std::string where = is_device(cell)     ? cell.executor
                                  : cell.threads == 1 ? "1 thread"
                                                      : fmt::format("{} threads", cell.threads);
        return fmt::format("\n{}, {}, {}\n", scene, cell.task, where);
    }

    std::string times() const {
        TextTable table({"  cell", "answer", "phase", ">n", ">median", ">MAD", ">min", ">p95",
                         ">p99", ">times the limit"});
        for (const Cell* cell : cells_) {
            std::vector<std::string> row{"  " + labels_.at(cell->cell_id),
                                         std::string(to_string(cell->status))};
            const auto timed = medians_.find(cell->cell_id);
            if (timed == medians_.end()) {
                table.add(row);
                continue;
            }
            for (const Median* median : timed->second) {
                row.insert(row.end(),
                           {std::string(to_string(median->phase)), std::to_string(median->n)});
                for (const double ns : {median->median_ns, median->mad_ns, median->min_ns,
                                        median->p95_ns, median->p99_ns})
                    row.push_back(time_text(ns));
                row.push_back(index_.is_peer(*cell) ? "" : ratio_text(median->times_limit));
                table.add(std::move(row));
                row = {"", ""};
            }
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
                    if (check->status == results::Status::wrong)
                        text += fmt::format("  wrong, not ranked: {}: {} missing and {} extra of "
                                            "{}; {}\n",
                                            label, check->missing, check->extra, check->n_expected,
                                            check->witness);
                    else if (check->status == results::Status::unsupported)
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

    /// Cell b against cell a: the time of a over that of b, and so above 1 where b is the faster.
    std::string comparisons() const {
        TextTable table(
            {"  compared", "with", "family", "phase", ">rounds", ">time of that/this", "verdict"});
        for (const Comparison& row : results_.compare) {
            if (!labels_.contains(row.cell_b))
                continue;
            const auto other = labels_.find(row.cell_a);
            const std::string family =
                fmt::format("{}{}{}", to_string(row.family),
                            row.contender_class.empty() ? "" : ", ", row.contender_class);
            table.add({"  " + labels_.at(row.cell_b),
                       other != labels_.end() ? other->second : elsewhere(row), family,
                       std::string(to_string(row.phase)), std::to_string(row.n_pairs),
                       interval_text(1 / row.ratio, 1 / row.ci_hi, 1 / row.ci_lo), row.words});
        }
        return table.empty() ? "" : table.text();
    }

    /// What a cell is compared with that is of another job.
    std::string elsewhere(const Comparison& row) const {
        if (row.family != results::Family::devices)
            return "itself on one thread";
        const Cell& other = index_.cell(row.cell_a);
        return fmt::format("{}, {} thread{}", label_of(other), other.threads,
                           other.threads == 1 ? "" : "s");
    }

    const Index& index_;
    const Results& results_;
    std::vector<const Cell*> cells_;
    std::map<std::uint32_t, std::string> labels_;
    std::map<std::uint32_t, std::vector<const Median*>> medians_;
    std::map<std::uint32_t, std::vector<const Check*>> checks_;
};

/// A row as a JSON object.
std::string json_of(const results::Table& table, const std::byte* row) {
    const auto count = []<class Value>(Value value) {
        return value == std::numeric_limits<Value>::max() ? "null" : std::to_string(value);
    };
    std::string text;
    for (const results::Column& column : table.columns) {
        text += (text.empty() ? "{" : ", ") + json_string(column.name) + ": ";
        switch (column.stored) {
        case results::Stored::uint32:
            text += count(column.value<std::uint32_t>(row));
            break;
        case results::Stored::uint64:
            text += count(column.value<std::uint64_t>(row));
            break;
        case results::Stored::real:
            text += json_number(column.value<double>(row));
            break;
        case results::Stored::text:
            text += json_string(column.text(row));
            break;
        }
    }
    return text + "}";
}

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (const char c : text)
        quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string csv_number(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

} // namespace

std::string all_text(const Results& results) {
    std::string text = header_text(results) + scenes_text(results);
    if (!results.kernels.empty())
        text += "\n" + kernel_costs_text(results) + "\n" + promises_text(results);
    const Index index(results);
    std::map<JobKey, std::vector<const Cell*>> groups;
    std::vector<JobKey> order;
    for (const Cell& cell : results.cells) {
        const JobKey job = job_of(cell);
        if (!groups.contains(job))
            order.push_back(job);
        groups[job].push_back(&cell);
    }
    for (const JobKey& job : order)
        text += Group(index, groups[job]).text();
    return text + devices_text(results) + findings_text(results);
}

std::string csv_text(const Results& results) {
    std::map<std::uint32_t, const Cell*> cells;
    for (const Cell& cell : results.cells)
        cells[cell.cell_id] = &cell;
    std::string text = "cell,status,phase,n,median_ns,mad_ns,min_ns,p95_ns,p99_ns,limit_ns\n";
    for (const Median& row : results.medians) {
        const Cell& cell = *cells.at(row.cell_id);
        text += fmt::format("{},{},{},{}", csv_field(cell.name), to_string(cell.status),
                            to_string(row.phase), row.n);
        for (const double ns :
             {row.median_ns, row.mad_ns, row.min_ns, row.p95_ns, row.p99_ns, row.limit_ns})
            text += "," + csv_number(ns);
        text += "\n";
    }
    return text;
}

std::string json_text(const Results& results) {
    std::string text;
    for (const results::Table& table : results::tables()) {
        if (!table.is_derived && table.name != "cells")
            continue;
        const auto rows = table.rows(results);
        std::string all;
        for (std::size_t i = 0; i < rows.n; ++i)
            all += (i == 0 ? "\n  " : ",\n  ") + json_of(table, rows[i]);
        text += fmt::format("{}\"{}\": [{}]", text.empty() ? "{" : ",\n ", table.name, all);
    }
    return text + "}\n";
}

std::string google_benchmark_text(const Results& results) {
    struct Benchmark {
        const Cell* cell;
        std::vector<const results::Sample*> samples;
    };
    std::map<std::uint32_t, const Cell*> cells;
    for (const Cell& cell : results.cells)
        cells[cell.cell_id] = &cell;
    std::map<std::pair<std::uint32_t, Phase>, Benchmark> benchmarks;
    for (const results::Sample& sample : results.samples) {
        if ((sample.flags & results::aa_twin) != 0)
            continue;
        Benchmark& benchmark = benchmarks[{sample.cell_id, sample.phase}];
        benchmark.cell = cells.at(sample.cell_id);
        benchmark.samples.push_back(&sample);
    }
    const results::Env env = results.env.empty() ? results::Env{} : results.env.front();
    std::string text = fmt::format(
        "{{\"context\": {{\"executable\": \"boxwood\", \"host_name\": {}, \"num_cpus\": {}, "
        "\"mhz_per_cpu\": {}, \"caches\": [], \"library_build_type\": \"release\", "
        "\"commit\": {}}},\n\"benchmarks\": [",
        json_string(env.host), env.ncpu,
        std::isnan(env.core_ghz) ? 0 : std::lround(1000 * env.core_ghz),
        json_string(env.git_commit));
    std::size_t family = 0;
    const char* separator = "\n";
    for (const auto& [key, benchmark] : benchmarks) {
        const std::string name =
            json_string(fmt::format("{}/{}", benchmark.cell->name, to_string(key.second)));
        const bool is_wrong = !is_right(benchmark.cell->status);
        for (std::size_t i = 0; i < benchmark.samples.size(); ++i) {
            const results::Sample& sample = *benchmark.samples[i];
            text += fmt::format(
                "{}{{\"name\": {}, \"run_name\": {}, \"family_index\": {}, "
                "\"per_family_instance_index\": 0, \"run_type\": \"iteration\", "
                "\"repetitions\": {}, \"repetition_index\": {}, \"threads\": {}, {}"
                "\"iterations\": {}, \"real_time\": {}, \"cpu_time\": {}, \"time_unit\": "
                "\"ns\"}}",
                separator, name, name, family, benchmark.samples.size(), i, benchmark.cell->threads,
                is_wrong ? fmt::format("\"error_occurred\": true, \"error_message\": {}, ",
                                       json_string(std::string(to_string(benchmark.cell->status))))
                         : std::string(),
                sample.iterations, json_number(sample.wall_ns),
                json_number(std::isnan(sample.cpu_ns) ? sample.wall_ns : sample.cpu_ns));
            separator = ",\n";
        }
        ++family;
    }
    return text + "\n]}\n";
}

void add_show(CLI::App& app, int&) {
    struct Options {
        std::string file;
        bool all = false, csv = false, json = false, google_benchmark = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* show = app.add_subcommand("show", "what a result file says: one screen of findings");
    show->add_option("file", options->file, "a result file (HDF5)")->required();
    CLI::Option* all = show->add_flag("--all", options->all,
                                      "every cell with its times and checks, every comparison");
    CLI::Option* csv =
        show->add_flag("--csv", options->csv, "the times of every cell as CSV")->excludes(all);
    CLI::Option* json =
        show->add_flag("--json", options->json, "cells and every derived table as JSON")
            ->excludes(all)
            ->excludes(csv);
    show->add_flag("--google-benchmark", options->google_benchmark,
                   "the samples as google-benchmark's JSON, for its compare.py")
        ->excludes(all)
        ->excludes(csv)
        ->excludes(json);
    show->footer("Example: boxwood show quick.h5");
    show->callback([options] {
        const Results results = read_results(options->file);
        if (options->csv)
            std::cout << csv_text(results);
        else if (options->json)
            std::cout << json_text(results);
        else if (options->google_benchmark)
            std::cout << google_benchmark_text(results);
        else if (options->all)
            std::cout << all_text(results);
        else
            std::cout << screen_text(results) << paths_text(options->file);
    });
}

} // namespace boxwood::bench
