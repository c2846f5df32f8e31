#include "bench/running/sweep.h"

#include "bench/analysis/analyse.h"
#include "bench/analysis/promises.h"
#include "bench/analysis/screen.h"
#include "bench/analysis/statistics.h"
#include "bench/io/bad_input.h"
#include "bench/io/csv.h"
#include "bench/io/read_results.h"
#include "bench/io/say.h"
#include "bench/machine/environment.h"
#include "bench/machine/quiet.h"
#include "bench/running/calibration.h"
#include "bench/running/child.h"
#include "bench/running/inputs.h"
#include "bench/running/instructions/count.h"
#include "bench/running/prepare.h"
#include "bench/running/shards.h"
#include "bench/truth/crash.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <optional>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

constexpr double callgrind_slowdown = 50;

constexpr std::size_t max_padding = 4096; ///< a page: beyond it all comes again

/// A sweep as its parent process sees it: children work, it waits, keeps and joins.
class Sweep {
  public:
    explicit Sweep(const SweepOptions& options)
        : options_(options), plan_(make_plan(read_text(options.config.string()),
                                             options.config.string(), options.overrides)),
          shards_(options.out, plan_.sweep_hash, environment(false).env_hash) {}

    int run() {
        if (options_.shard >= plan_.rounds)
            throw BadInput(fmt::format("--shard {}/{} has none of the {} rounds", options_.shard,
                                       options_.shards, plan_.rounds));
        shards_.open(); // before OUT is read: no other sweep may write it meanwhile
        if (options_.counts)
            return count();
        read_earlier_output();
        write_sweep_file();
        if (!get_prepared() || !run_rounds() || !run_more_rounds())
            return stop();
        return finish();
    }

  private:
    using Cost = std::function<double(const std::string& cell)>;

    /// OUT may hold this sweep already, whole or in part; any other file is left alone.
    void read_earlier_output() {
        if (!fs::exists(options_.out))
            return;
        const std::string advice = "choose another --out, or remove the file";
        try {
            earlier_ = read_results(options_.out);
        } catch (const std::runtime_error& error) {
            throw BadInput(fmt::format("--out: {}; {}", error.what(), advice));
        }
        if (earlier_->sweep_hash != plan_.sweep_hash)
            throw BadInput(fmt::format("--out: {} holds another sweep (other cells, seed or "
                                       "times); {}",
                                       options_.out.string(), advice));
        if (!shards_.belongs(*earlier_))
            throw BadInput(fmt::format("--out: {} was measured on another machine or by another "
                                       "build; {} (boxwood merge joins files)",
                                       options_.out.string(), advice));
    }

    /// Children read this copy: the original may be edited while the sweep runs.
    void write_sweep_file() const {
        std::ofstream file(shards_.sweep_file(), std::ios::binary);
        file << plan_.config_text << std::flush;
        if (!file)
            throw BadInput(fmt::format("cannot write {}", shards_.sweep_file().string()));
    }

    /// The instructions of our cells instead of rounds.
    int count() {
        const fs::path counted = shards_.folder() / "counted.h5",
                       dumps = shards_.folder() / "callgrind";
        std::vector<std::string> arguments = under_callgrind(fs::absolute(dumps));
        if (fs::exists(options_.out))
            throw BadInput(fmt::format("--out: {} is there already; choose another, or remove it",
                                       options_.out.string()));
        write_sweep_file();
        if (!get_prepared())
            return stop();
        const std::vector<std::string> own = child_arguments(counted);
        arguments.insert(arguments.end(), own.begin() + 1, own.end());
        arguments.insert(arguments.end(), {"--prepared", shards_.prepared_file().string(),
                                           "--dumps", dumps.string()});
        const auto cells = std::ranges::count_if(plan_.cells, is_counted);
        while (!fs::exists(counted)) {
            Eta eta(static_cast<double>(cells));
            const ChildEnd end = run_child_process(
                "counting", arguments, 0, eta, [](const auto&) { return 1.0; }, "valgrind");
            if (end.kind == ChildEnd::Kind::interrupted)
                return stop();
            note_crash(end, "the count");
            take_out_crashed();
        }
        merged_ = results::read(counted);
        put_in_place();
        shards_.remove();
        progress_.say(fmt::format("instructions of {} cells are in {}; boxwood compare --count "
                                  "compares two such files",
                                  cells, options_.out.string()));
        return is_promise_broken(merged_) ? exit_failed : exit_success;
    }

    /// False if it was interrupted.
    bool get_prepared() {
        std::optional<results::Results> found = shards_.prepared();
        if (!found && earlier_) {
            found = without_rounds(*earlier_);
            results::write(shards_.prepared_file(), *found);
        }
        while (!found) {
            std::vector<std::string> arguments = child_arguments(shards_.prepared_file());
            arguments.push_back("--prepare");
            for (const auto& [cell, witness] : crashed_)
                arguments.insert(arguments.end(), {"--skip", cell});
            double steps = 0;
            for (const PlannedCell& cell : plan_.cells)
                steps += has_inputs(cell) ? plan_.inputs : 1;
            Eta eta(steps);
            const ChildEnd end =
                run_child_process("preparing", arguments, 0, eta, [](const auto&) { return 1.0; });
            if (end.kind == ChildEnd::Kind::interrupted)
                return false;
            note_crash(end, "the preparation");
            found = shards_.prepared();
            if (!found && end.kind == ChildEnd::Kind::done)
                throw BadInput(
                    fmt::format("{} cannot be read back", shards_.prepared_file().string()));
        }
        prepared_ = std::move(*found);
        take_out_crashed();
        say_what_no_device_can();
        return true;
    }

    /// Who runs a sweep of devices where there is none shall not look for their rows.
    void say_what_no_device_can() {
        std::map<std::string, std::size_t> cells_by_reason;
        for (const results::Check& check : prepared_.checks)
            if (check.status == results::Status::unsupported &&
                is_device(prepared_.cells.at(check.cell_id).executor))
                ++cells_by_reason[check.witness];
        for (const auto& [reason, cells] : cells_by_reason)
            progress_.say(fmt::format("{} of a device left out: {}",
                                      cells == 1 ? "a cell" : fmt::format("{} cells", cells),
                                      reason));
    }

    /// False if it was interrupted.
    bool run_rounds() {
        std::set<unsigned> done = earlier_ ? rounds_in(*earlier_) : std::set<unsigned>{};
        for (const auto& [round, results] : shards_.rounds())
            done.insert(round);
        std::vector<unsigned> wanted;
        for (unsigned round = options_.shard; round < plan_.rounds; round += options_.shards)
            if (!done.contains(round))
                wanted.push_back(round);
        if (!done.empty() && rounds_run_ == 0)
            progress_.say(fmt::format("{} rounds are there from an earlier start; {} to go",
                                      done.size(), wanted.size()));

        Calibrations calibrations = calibrations_of(prepared_.texts["calibration"]);
        double all_s = 0;
        std::map<std::string, double> s_of; // by cell
        for (const PlannedCell& cell : plan_.cells)
            if (const auto found = calibrations.find(cell.name); found != calibrations.end()) {
                s_of[cell.name] = cell_s(cell, found->second);
                all_s += s_of[cell.name] *
                         static_cast<double>(std::ranges::count_if(
                             wanted, [&](unsigned round) { return cell.is_in(round); }));
            }
        Eta eta(all_s);
        if (!quiet_wait_)
            quiet_wait_.emplace(std::min(options_.wait_s, all_s));
        if (rounds_run_ == 0)
            start_ = std::chrono::steady_clock::now();
        for (auto round = wanted.begin(); round != wanted.end();) {
            if (*round >= min_pairs_verdict * options_.shards && !has_time_for_a_round()) {
                plan_.rounds = *round;
                return true;
            }
            const double other_cores = wait_until_quiet(eta.fraction());
            std::vector<std::string> arguments = child_arguments(shards_.round_file(*round));
            arguments.insert(arguments.end(), {"--round", std::to_string(*round), "--prepared",
                                               shards_.prepared_file().string(), "--other-cores",
                                               fmt::format("{:.2f}", other_cores)});
            const ChildEnd end =
                run_child_process(fmt::format("round {}/{}", *round + 1, plan_.rounds), arguments,
                                  order_seed_of(plan_.seed, *round) % max_padding, eta,
                                  [&](const std::string& cell) { return s_of[cell]; });
            if (end.kind == ChildEnd::Kind::interrupted)
                return false;
            note_crash(end, fmt::format("round {}", *round + 1));
            take_out_crashed();
            if (!fs::exists(shards_.round_file(*round)))
                continue;
            ++rounds_run_;
            if (!progress_.is_terminal())
                progress_.say(
                    fmt::format("round {}/{} done, {} left", *round + 1, plan_.rounds,
                                duration_text(std::max(
                                    eta.left_s(elapsed_s()),
                                    options_.budget_s > 0 ? options_.budget_s - elapsed_s() : 0))));
            ++round;
        }
        return true;
    }

    /// Gives how many processors work for others. What comes of an interrupt shows in the round.
    double wait_until_quiet(double fraction) {
        const bool may_wait = quiet_wait_->may_wait();
        const double cores = quiet_wait_->wait([&](double busy) {
            progress_.show({fmt::format("waiting for a quiet machine ({:.1f} cores busy)", busy),
                            fraction, -1, ""});
            return !interrupt_.requested();
        });
        if (may_wait && cores > results::quiet_cores && !quiet_wait_->may_wait())
            progress_.say(fmt::format("other programs take {:.1f} processors, and rounds wait no "
                                      "longer: times will be noisy",
                                      cores));
        return cores;
    }

    bool has_time_for_a_round() const {
        return options_.budget_s == 0 ||
               elapsed_s() * (1 + 1. / std::max(1u, rounds_run_)) <= options_.budget_s;
    }

    /// Of those planned or more, while there is time and a comparison with a peer is open. False if
    /// it was interrupted.
    bool run_more_rounds() {
        while (options_.budget_s > 0 && write_output()) {
            const auto open = std::ranges::count_if(merged_.compare, [](const auto& row) {
                return row.family == results::Family::peers &&
                       row.verdict == results::Verdict::cannot_tell &&
                       row.reason != results::Reason::unchecked;
            });
            if (open == 0 || !has_time_for_a_round()) {
                progress_.say(open == 0 ? "every comparison with a peer has its verdict"
                                        : fmt::format("the budget is spent; {} of {} comparisons "
                                                      "are open",
                                                      open, merged_.compare.size()));
                return true;
            }
            plan_.rounds += options_.shards;
            if (!run_rounds())
                return false;
        }
        return true;
    }

    ChildEnd run_child_process(const std::string& stage, const std::vector<std::string>& arguments,
                               std::size_t padding, Eta& eta, const Cost& cost,
                               const char* program = own_program) {
        double at_work = 0; // expected cost of the cell that runs now
        const Report report = [&](std::size_t, std::size_t, const std::string& cell) {
            eta.done(at_work);
            at_work = cost(cell);
            progress_.show({stage, eta.fraction(), eta.left_s(elapsed_s()), cell});
        };
        progress_.show({stage, eta.fraction(), -1, ""});
        ChildEnd end = run_child(arguments, max_threads(), padding, interrupt_, report,
                                 options_.give_up_s, program);
        eta.done(at_work);
        if (end.kind == ChildEnd::Kind::failed)
            throw BadInput(fmt::format("{}; what is finished is kept in {}: mend this and start "
                                       "the same command again",
                                       end.cause, shards_.folder().string()));
        return end;
    }

    /// A cell that brings its process down twice, or hangs, is out.
    void note_crash(const ChildEnd& end, const std::string& where) {
        const bool hung = end.kind == ChildEnd::Kind::hung;
        if (end.kind != ChildEnd::Kind::crashed && !hung)
            return;
        const unsigned times = crashes_[end.cell] += hung ? 2 : 1;
        if (end.cell.empty() && times >= 2)
            throw BadInput(
                fmt::format("{} failed twice outside of any cell: {}", where, end.cause));
        if (times >= 2)
            crashed_[end.cell] = crash_text(fmt::format("{} in {}", end.cause, where));
        progress_.say(
            fmt::format("{} {} in {}: {}; {}", where, hung ? "stood still" : "crashed",
                        end.cell.empty() ? "no cell" : end.cell, end.cause,
                        times >= 2 ? "that cell is left out from here on" : "it is run again"));
    }

    void take_out_crashed() {
        bool is_new = false;
        for (const auto& [cell, witness] : crashed_)
            is_new |= mark_crashed(prepared_, cell, witness);
        if (is_new)
            results::write(shards_.prepared_file(), prepared_);
    }

    std::vector<std::string> child_arguments(const fs::path& out) const {
        std::vector<std::string> arguments{
            "boxwood",      "round",          "--config",    shards_.sweep_file().string(),
            "--sweep-hash", plan_.sweep_hash, "--shard-out", out.string()};
        Overrides overrides = options_.overrides;
        overrides.seed = plan_.seed;
        std::ranges::move(overrides.arguments(), std::back_inserter(arguments));
        return arguments;
    }

    /// Joins what is there and puts it in place of OUT. False if there is no round yet.
    bool write_output() {
        std::vector<results::Results> parts{prepared_};
        std::set<unsigned> done;
        if (earlier_) {
            done = rounds_in(*earlier_);
            parts.push_back(*earlier_);
            parts.back().texts.clear(); // those of the preparation hold
        }
        for (auto& [round, results] : shards_.rounds())
            if (done.insert(round).second)
                parts.push_back(std::move(results));
        if (done.empty())
            return false;
        merged_ = results::merge(parts);
        put_in_place();
        return true;
    }

    /// What was merged or counted becomes OUT.
    void put_in_place() {
        merged_.texts["argv"] = options_.command_line;
        merged_.texts["lscpu"] = lscpu_text();
        merged_.texts["cmake_cache"] = cmake_cache_text();
        analyse(merged_, plan_.delta);
        const fs::path merged_file = shards_.folder() / "merged.h5";
        results::write(merged_file, merged_);
        fs::rename(merged_file, options_.out);
    }

    int stop() {
        const bool has_output = write_output();
        progress_.say(!options_.goes_on
                          ? "interrupted"
                          : fmt::format("interrupted; {}. The same command goes on from here.",
                                        has_output ? fmt::format("{} rounds are in {}",
                                                                 rounds_in(merged_).size(),
                                                                 options_.out.string())
                                                   : std::string("no round was finished")));
        if (!options_.goes_on)
            shards_.remove();
        return exit_interrupted;
    }

    int finish() {
        progress_.show({"joining", 1, -1, ""});
        write_output();
        shards_.remove();
        progress_.say("");
        if (!options_.is_quiet)
            fmt::print("{}{}", screen_text(merged_), paths_text(options_.out));
        if (merged_.samples.empty()) {
            progress_.say("nothing was timed, as no cell can run here");
            return exit_failed;
        }
        return is_promise_broken(merged_) ? exit_failed : exit_success;
    }

    unsigned max_threads() const {
        return std::ranges::max(plan_.cells, {}, &PlannedCell::threads).threads;
    }
    double elapsed_s() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

    const SweepOptions& options_;
    Plan plan_;
    Shards shards_;
    Interrupt interrupt_;
    Progress progress_{stderr};
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    unsigned rounds_run_ = 0;
    std::optional<QuietWait> quiet_wait_;
    std::optional<results::Results> earlier_; ///< what OUT held before
    results::Results prepared_, merged_;
    std::map<std::string, unsigned> crashes_;    ///< how often, by cell
    std::map<std::string, std::string> crashed_; ///< cells that are out, and their witness
};

} // namespace

void list_cells(const SweepOptions& options) {
    const Plan plan =
        make_plan(read_text(options.config.string()), options.config.string(), options.overrides);
    const unsigned rounds = (plan.rounds + options.shards - 1 - options.shard) / options.shards;
    double guess_s = 0; // the preparation takes about as long as a round for each input
    if (options.counts) {
        std::size_t counted = 0;
        for (const PlannedCell& cell : plan.cells)
            if (is_counted(cell)) {
                fmt::print("{}\n", cell.name);
                guess_s += callgrind_slowdown * guessed_cell_s(cell, 0);
                ++counted;
            }
        say(fmt::format("{} cells to count, sweep {}: about {} (a guess)\n", counted,
                        plan.sweep_hash, duration_text(guess_s)));
        return;
    }
    for (const PlannedCell& cell : plan.cells) {
        fmt::print("{}\n", cell.name);
        guess_s +=
            guessed_cell_s(cell, plan.min_time_ms) *
            (std::min(rounds, cell.rounds.value_or(rounds)) + (has_inputs(cell) ? plan.inputs : 1));
    }
    std::fflush(stdout); // the time comes last
    say(fmt::format("{} cells, {} rounds, sweep {}: about {} (a guess; the preparation measures)\n",
                    plan.cells.size(), rounds, plan.sweep_hash, duration_text(guess_s)));
}

int run_sweep(const SweepOptions& options) { return Sweep(options).run(); }

} // namespace boxwood::bench
