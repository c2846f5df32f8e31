/// `boxwood sweep --against PROGRAM`: a sweep of this program and one of another, a round of each
/// in turn.

#include "bench/running/sweep.h"

#include "bench/io/bad_input.h"
#include "bench/io/csv.h"
#include "bench/io/progress.h"
#include "bench/io/read_results.h"
#include "bench/running/child.h"
#include "bench/running/shards.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <sstream>
#include <unistd.h>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

struct Side {
    fs::path program, out;
    const char* name;

    /// Beside the file that it makes, by a name of its own: OUT.log may be a file of the user.
    fs::path log() const { return out.string() + ".turns.log"; }
    unsigned rounds_done() const {
        return fs::exists(out) ? static_cast<unsigned>(rounds_in(read_results(out)).size()) : 0;
    }
};

/// What is as it is by default is not said: a program of before may not know the option.
std::vector<std::string> arguments_of(const Side& side, const SweepOptions& options,
                                      unsigned rounds) {
    std::vector<std::string> words{
        "boxwood", "sweep",           "--config", options.config.string(),
        "--out",   side.out.string(), "--rounds", std::to_string(rounds)};
    std::ranges::move(options.overrides.arguments(), std::back_inserter(words));
    const SweepOptions by_default;
    if (options.wait_s != by_default.wait_s)
        words.insert(words.end(), {"--wait", fmt::format("{}s", options.wait_s)});
    if (options.give_up_s != by_default.give_up_s)
        words.insert(words.end(), {"--give-up", fmt::format("{}s", options.give_up_s)});
    return words;
}

std::string last_line(const fs::path& log) {
    std::istringstream lines(read_text(log.string()));
    std::string last;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty())
            last = line;
    return last;
}

/// False if it was interrupted.
bool sweep_to(const Side& side, const SweepOptions& options, unsigned rounds,
              Interrupt& interrupt) {
    const int code =
        run_logged(side.program, arguments_of(side, options, rounds), side.log(), interrupt);
    if (code == exit_interrupted)
        return false;
    // A wrong answer is the comparison's business.
    if ((code != exit_success && code != exit_failed) || !fs::exists(side.out))
        throw BadInput(fmt::format("--against: {} cannot do this sweep (exit code {}): {}",
                                   side.program.string(), code, last_line(side.log())));
    return true;
}

} // namespace

fs::path base_file_of(const fs::path& out) {
    return fs::path(out).replace_extension(".base" + out.extension().string());
}

bool sweep_in_turns(const fs::path& program, const SweepOptions& options) {
    const unsigned rounds =
        make_plan(read_text(options.config.string()), options.config.string(), options.overrides)
            .rounds;
    if (access(program.c_str(), X_OK) != 0 || fs::is_directory(program))
        throw BadInput(fmt::format("--against: '{}' is no program", program.string()));
    std::array sides{Side{program, base_file_of(options.out), "base"},
                     Side{fs::read_symlink(own_program), options.out, "head"}};
    Interrupt interrupt;
    Progress progress(stderr);
    const unsigned first = std::min(sides[0].rounds_done(), sides[1].rounds_done());
    const auto start = std::chrono::steady_clock::now();
    Eta eta(2. * (rounds - std::min(first, rounds)));
    for (unsigned round = first; round < rounds; ++round) {
        for (const Side& side : sides) {
            const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
            progress.show({fmt::format("round {}/{} of {}", round + 1, rounds, side.name),
                           eta.fraction(), eta.left_s(elapsed.count()), ""});
            if (!sweep_to(side, options, round + 1, interrupt)) {
                progress.say("interrupted; the same command goes on from here");
                return false;
            }
            eta.done(1);
        }
        if (!progress.is_terminal())
            progress.say(fmt::format("round {}/{} of both done", round + 1, rounds));
        std::ranges::reverse(sides); // who comes first takes turns, too
    }
    progress.say("");
    for (const Side& side : sides)
        fs::remove(side.log());
    return true;
}

} // namespace boxwood::bench
