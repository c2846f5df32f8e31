#include "bench/running/sweep.h"

#include "bench/commands/against.h"
#include "bench/commands/command.h"
#include "bench/commands/compare.h"
#include "bench/commands/option_ranges.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string_view>

namespace boxwood::bench {
namespace {

void add_plan_options(CLI::App& command, std::filesystem::path& config, Overrides& overrides) {
    command
        .add_option("--config", config,
                    "what to measure: a sweep file such as bench/configs/quick.toml")
        ->required();
    command
        .add_option("--mesh", overrides.meshes,
                    "a mesh of your own (OBJ, PLY, STL, ...) for the blocks with scene = \"mesh\"; "
                    "without it they are left out; may be given more than once")
        ->allow_extra_args(false);
    command
        .add_option("--boxes", overrides.boxes,
                    "boxes of your own (CSV, min_x,min_y,min_z,max_x,max_y,max_z a line) for the "
                    "blocks with scene = \"boxes\"; may be given more than once")
        ->allow_extra_args(false);
    command
        .add_option("--rays", overrides.rays,
                    "rays of your own (CSV, ox,oy,oz,dx,dy,dz[,tmax] a line), cast at each --mesh "
                    "instead of generated ones; may be given more than once")
        ->allow_extra_args(false);
    command
        .add_option("--motion", overrides.motions,
                    "boxes that move, of your own (CSV, frame,body,min_x,min_y,min_z,max_x,max_y,"
                    "max_z a line; a body without a line stays), for the blocks with scene = "
                    "\"motion\"; may be given more than once")
        ->allow_extra_args(false);
    command
        .add_option(
            "--robot", overrides.robots,
            "a robot of your own (URDF; with FILE.srdf beside it the pairs of its links "
            "that may touch, else adjacent ones) for the blocks with scene = \"robot\"; may "
            "be given more than once")
        ->allow_extra_args(false);
    command
        .add_option("--threads", overrides.threads,
                    "numbers of threads, such as 1,2, instead of those of the sweep file")
        ->delimiter(',')
        ->check(CLI::Range(1, 1024));
    command.add_option("--only", overrides.only,
                       "only cells whose name this regular expression is found in");
    command.add_option("--seed", overrides.seed, "seed of scenes and shuffling")
        ->check(seed_range());
}

/// "0/2" -> 0 of 2.
void parse_shard(const std::string& text, SweepOptions& options) {
    const std::size_t slash = text.find('/');
    const auto number = [&](std::size_t from, std::size_t to, unsigned& value) {
        const char* end = text.data() + to;
        const auto result = std::from_chars(text.data() + from, end, value);
        return result.ec == std::errc{} && result.ptr == end;
    };
    if (slash == std::string::npos || !number(0, slash, options.shard) ||
        !number(slash + 1, text.size(), options.shards) || options.shard >= options.shards)
        throw BadInput(fmt::format("--shard \"{}\": write I/N with 0 <= I < N, such as 0/2", text));
}

/// "90s", "10min", "2h" -> seconds.
double duration_s(const std::string& option, const std::string& text, bool may_be_0) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
    const double unit_s = unit == "s" ? 1 : unit == "min" ? 60 : unit == "h" ? 3600 : 0;
    if (error != std::errc{} || unit_s == 0 ||
        !((value > 0 || (may_be_0 && value == 0)) && value <= 1e6))
        throw BadInput(
            fmt::format("{} \"{}\": write a time such as 90s, 10min or 2h", option, text));
    return value * unit_s;
}

/// The arguments of this process, blanks between them.
std::string own_command_line() {
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::string line;
    for (std::string argument; std::getline(file, argument, '\0');)
        line += (line.empty() ? "" : " ") + argument;
    return line;
}

void add_child(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ChildOptions>();
    CLI::App* child =
        app.add_subcommand("round", "one process of a sweep; started by boxwood sweep");
    child->group(""); // not listed in the help
    add_plan_options(*child, options->config, options->overrides);
    child->add_option("--sweep-hash", options->sweep_hash, "of the parent's plan")->required();
    child->add_option("--shard-out", options->out, "the file to write")->required();
    child->add_option("--prepared", options->prepared, "what the preparation wrote");
    child->add_flag("--prepare", options->is_preparation, "prepare instead of timing a round");
    child->add_option("--dumps", options->dumps, "count instructions, which callgrind dumps there");
    child->add_option("--round", options->round, "the round's number, from 0");
    child->add_option("--cold", options->cold, "the cell whose first build is timed");
    child->add_option("--other-cores", options->other_cores, "processors at work for others");
    child->add_option("--skip", options->skip, "cells that the preparation leaves out")->take_all();
    child->add_option("--report-fd", options->report_fd, "where to report")->required();
    child->callback([options, &exit_code] { exit_code = run_sweep_child(*options); });
}

} // namespace

void add_sweep(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<SweepOptions>();
    auto shard = std::make_shared<std::string>();
    auto budget = std::make_shared<std::string>();
    auto wait = std::make_shared<std::string>("60s");
    auto give_up = std::make_shared<std::string>("10min");
    auto is_dry_run = std::make_shared<bool>(false);
    auto against = std::make_shared<std::filesystem::path>();
    auto fail_if = std::make_shared<std::string>();
    CLI::App* sweep = app.add_subcommand(
        "sweep", "time and check the cells of a sweep file; goes on where it was interrupted");
    add_plan_options(*sweep, options->config, options->overrides);
    sweep->add_option("--out", options->out, "the result file to write (HDF5)");
    sweep
        ->add_option("--rounds", options->overrides.rounds,
                     "how often each cell is timed; more rounds extend an earlier sweep")
        ->check(CLI::Range(1, 10'000));
    CLI::Option* const of_shards =
        sweep->add_option("--shard", *shard,
                          "I/N: only the rounds with number mod N = I (boxwood merge joins the "
                          "files)");
    CLI::Option* const timed = sweep->add_option(
        "--budget", *budget,
        "time for the rounds, such as 90s, 10min or 2h: more rounds than planned while "
        "comparisons with peers are open, fewer (9 at least) where there is no more time");
    sweep
        ->add_option("--give-up", *give_up,
                     "a cell in which a process hangs for so long is left out, as a wrong answer")
        ->capture_default_str();
    sweep
        ->add_option("--wait", *wait,
                     "how long rounds wait in all for other programs to end, and no longer than "
                     "they take; 0s: not at all")
        ->capture_default_str();
    CLI::Option* const rounds = sweep->get_option("--rounds");
    CLI::Option* const counts =
        sweep
            ->add_flag("--count", options->counts,
                       "instead of timed rounds count the instructions of each cell of ours on one "
                       "thread, under valgrind: for boxwood compare --count, which no noise "
                       "disturbs")
            ->excludes(rounds)
            ->excludes(of_shards)
            ->excludes(timed);
    CLI::Option* const dry_run = sweep->add_flag(
        "--dry-run", *is_dry_run, "list the cells and guess the time; measure nothing");
    CLI::Option* const other =
        sweep
            ->add_option("--against", *against,
                         "another boxwood program, such as that of the commit before: the rounds "
                         "of both take turns, its results go to OUT.base.h5, and both are compared")
            ->excludes(of_shards)
            ->excludes(timed)
            ->excludes(dry_run)
            ->excludes(counts);
    sweep
        ->add_option("--fail-if", *fail_if,
                     "of --against: what counts as a regression, as boxwood compare has it")
        ->needs(other);
    sweep->footer("Example: boxwood sweep --config bench/configs/quick.toml --out quick.h5\n"
                  "Exit codes: 0 fine, 1 one of our answers is wrong, a contender crashed or "
                  "nothing could be timed, 2 bad input, 130 interrupted; with --against those of "
                  "boxwood compare.");
    sweep->callback([=, &exit_code] {
        if (!shard->empty())
            parse_shard(*shard, *options);
        if (!budget->empty())
            options->budget_s = duration_s("--budget", *budget, false);
        options->wait_s = duration_s("--wait", *wait, true);
        options->give_up_s = duration_s("--give-up", *give_up, false);
        options->command_line = own_command_line();
        if (*is_dry_run)
            return list_cells(*options);
        if (options->out.empty() && !options->config.empty() &&
            !std::filesystem::exists(options->config))
            throw BadInput(options->config.string() + ": no such file");
        if (options->out.empty())
            throw BadInput("sweep: say where the results go: --out FILE.h5");
        if (against->empty()) {
            exit_code = run_sweep(*options);
            return;
        }
        FileOptions compared;
        if (!fail_if->empty())
            compared.fail_if = fail_threshold(*fail_if);
        exit_code = run_against(*against, *options, compared);
    });
    add_child(app, exit_code);
}

} // namespace boxwood::bench
