#pragma once

#include "bench/io/progress.h"
#include "bench/running/interrupt.h"

#include <cstddef>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace boxwood::bench {

inline constexpr const char* own_program = "/proc/self/exe";

/// How a child process ended.
struct ChildEnd {
    enum class Kind {
        done,
        interrupted, ///< Ctrl-C reached the parent; the child was stopped
        crashed,     ///< by a signal, by exit(n), or by an exception within a cell
        hung,        ///< it reported nothing for too long, and was stopped
        failed       ///< it said why it cannot go on: no space left, a broken file
    };
    Kind kind = Kind::done;
    std::string cell;  ///< the one it was in, if any
    std::string cause; ///< "signal 11 (Segmentation fault)", or its own words
};

/// Runs this executable again, or a program that the PATH leads to, with other arguments (the first
/// is its name) and waits for its end. The child's environment
/// is fit for timing (idle OpenMP threads sleep; no google-benchmark settings from outside; malloc
/// asks for huge pages, for peers as for us), and larger by `padding` bytes, which moves the stack:
/// where memory lies is a matter of chance, too. It does not see Ctrl-C, and dies with its parent.
/// `--report-fd N` is added to the arguments: where a ChildReport writes. `report` gets what it
/// says; between two cells the parent sleeps, so as to take no time from what is measured. Throws
/// std::system_error if no process can be started. A child that reports nothing for `silence_s`
/// hangs, and is stopped.
ChildEnd run_child(std::vector<std::string> arguments, unsigned max_threads, std::size_t padding,
                   Interrupt& interrupt, const Report& report, double silence_s = 600,
                   const char* program = own_program);

/// Of this process.
std::size_t own_padding();

/// Runs this executable again with other arguments in this environment, and gives what it writes to
/// stdout. It dies with this process. Throws std::runtime_error unless it exits with 0, and
/// std::system_error if no process can be started.
std::string output_of_child(std::vector<std::string> arguments);

/// Runs a program in this environment, what it prints goes to the file `log`, and waits for its
/// end. A Ctrl-C, and the end of this process, is SIGTERM for it, so that it can keep what it has.
/// Gives its exit code, exit_interrupted after a Ctrl-C. Throws BadInput if a signal ends it, and
/// std::system_error if no process can be started.
int run_logged(const std::filesystem::path& program, std::vector<std::string> arguments,
               const std::filesystem::path& log, Interrupt& interrupt);

/// The child's side.
class ChildReport {
  public:
    explicit ChildReport(int descriptor) : descriptor_(descriptor) {}
    void at(std::size_t done, std::size_t total, const std::string& cell);
    /// No cell is at work any more: what goes wrong from here on is no cell's fault.
    void finishing() { send("finishing", ""); }
    void threw(const std::exception& error) { send("threw", error.what()); }
    void failed(const std::exception& error) { send("failed", error.what()); }

  private:
    void send(const char* word, std::string text);

    int descriptor_;
};

} // namespace boxwood::bench
