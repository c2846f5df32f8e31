#include "bench/commands/against.h"

#include "bench/commands/compare.h"
#include "bench/io/bad_input.h"
#include "bench/io/csv.h"
#include "bench/io/progress.h"
#include "bench/io/read_results.h"
#include "bench/running/interrupt.h"
#include "bench/running/shards.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

struct Side {
    fs::path program, out;
    const char* name;

    fs::path log() const { return fs::path(out).replace_extension(".log"); }
    unsigned rounds_done() const {
        return fs::exists(out) ? static_cast<unsigned>(rounds_in(read_results(out)).size()) : 0;
    }
};

std::vector<std::string> arguments_of(const Side& side, const SweepOptions& options,
                                      unsigned rounds) {
    const Overrides& o = options.overrides;
    std::vector<std::string> words{
        "boxwood", "sweep",           "--config", options.config.string(),
        "--out",   side.out.string(), "--rounds", std::to_string(rounds)};
    if (!o.threads.empty())
        words.insert(words.end(), {"--threads", fmt::format("{}", fmt::join(o.threads, ","))});
    if (!o.only.empty())
        words.insert(words.end(), {"--only", o.only});
    for (const std::string& word : o.own_files())
        words.push_back(word);
    if (o.seed)
        words.insert(words.end(), {"--seed", std::to_string(*o.seed)});
    return words;
}

/// The exit code; what it says goes to the log. A Ctrl-C of ours is passed on.
int sweep_to(const Side& side, const SweepOptions& options, unsigned rounds, Interrupt& interrupt) {
    std::vector<std::string> words = arguments_of(side, options, rounds);
    std::vector<char*> pointers;
    for (std::string& word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0)
        throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        pthread_sigmask(SIG_SETMASK, &interrupt.mask_before(), nullptr);
        const int log = open(side.log().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        dup2(log, STDOUT_FILENO);
        dup2(log, STDERR_FILENO);
        execv(side.program.c_str(), pointers.data());
        _exit(127);
    }
    const int end_of_child = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
    std::array<pollfd, 2> waiting{pollfd{end_of_child, POLLIN, 0},
                                  pollfd{interrupt.descriptor(), POLLIN, 0}};
    while (poll(waiting.data(), waiting.size(), -1) < 0 && errno == EINTR) {
    }
    if (interrupt.requested())
        kill(child, SIGTERM);
    close(end_of_child);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (interrupt.requested())
        return exit_interrupted;
    if (WIFEXITED(status))
        return WEXITSTATUS(status);
    throw BadInput(fmt::format("{} ended by signal {} in a sweep; its words are in {}",
                               side.program.string(), WTERMSIG(status), side.log().string()));
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
bool run_round(const Side& side, const SweepOptions& options, unsigned rounds,
               Interrupt& interrupt) {
    const int code = sweep_to(side, options, rounds, interrupt);
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

int run_against(const fs::path& program, const SweepOptions& options, const FileOptions& compared) {
    const unsigned rounds =
        make_plan(read_text(options.config.string()), options.config.string(), options.overrides)
            .rounds;
    if (access(program.c_str(), X_OK) != 0 || fs::is_directory(program))
        throw BadInput(fmt::format("--against: '{}' is no program", program.string()));
    std::array sides{Side{program, base_file_of(options.out), "base"},
                     Side{fs::read_symlink("/proc/self/exe"), options.out, "head"}};
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
            if (!run_round(side, options, round + 1, interrupt)) {
                progress.say("interrupted; the same command goes on from here");
                return exit_interrupted;
            }
            eta.done(1);
        }
        if (!progress.is_terminal())
            progress.say(fmt::format("round {}/{} of both done", round + 1, rounds));
        std::ranges::reverse(sides); // who comes first takes turns, too
    }
    const results::Results base = read_results(base_file_of(options.out)),
                           head = read_results(options.out);
    const FileComparison comparison = compare_files(base, head, compared);
    progress.say("");
    fmt::print("{}\nbase     {}\nhead     {}\n", comparison_text(base, head, comparison, compared),
               base_file_of(options.out).string(), options.out.string());
    for (const Side& side : sides)
        fs::remove(side.log());
    return exit_code_of(comparison.gate);
}

} // namespace boxwood::bench
