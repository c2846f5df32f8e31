#include "bench/commands/command.h"
#include "bench/io/say.h"
#include "bench/recording/recording_names.h"
#include "bench/replay/recorded_program.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

struct RecordOptions {
    std::string file = "recording.h5";
    std::vector<std::string> program; ///< and its arguments
};

/// What is loaded into the program.
fs::path record_library() {
    const fs::path library =
        fs::read_symlink("/proc/self/exe").parent_path() / "libboxwood_record.so";
    if (!fs::exists(library))
        throw BadInput(fmt::format("{} is not here: this boxwood was built without FCL; install "
                                   "libfcl-dev (scripts/setup does) and build again",
                                   library.string()));
    if (library.string().find_first_of(" :") != std::string::npos)
        throw BadInput(fmt::format("{}: the loader takes no path with a blank or a colon; build in "
                                   "another folder",
                                   library.string()));
    return library;
}

/// The files that the program's processes claim; none of them is there before.
std::vector<fs::path> recordings(const std::string& first) {
    std::vector<fs::path> files;
    for (unsigned i = 1; i <= recording::most_files; ++i)
        if (const fs::path file = recording::numbered(first, i); fs::exists(file))
            files.push_back(file);
    return files;
}

[[noreturn]] void become(const RecordOptions& options, const fs::path& library) {
    std::string preload = library.string();
    if (const char* const others = std::getenv("LD_PRELOAD"); others && *others)
        preload += std::string(":") + others;
    setenv("LD_PRELOAD", preload.c_str(), 1);
    setenv(recording::file_variable, fs::absolute(options.file).c_str(), 1);
    std::vector<char*> arguments;
    for (const std::string& argument : options.program)
        arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    fmt::print(stderr, "boxwood record: {}: {}\n", options.program[0], std::strerror(errno));
    _exit(127);
}

/// As a shell gives it: 128 and the signal of one that was killed.
int status_of(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return exit_failed;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// False if it cannot be read: the disk was full, say.
bool say_what_is_in(const fs::path& file) {
    try {
        const RecordedProgram program = read_program(file);
        fmt::print(stderr, "{}: {} calls, {} objects; boxwood replay {}\n", file.string(),
                   program.calls.size(), program.n_objects(), file.string());
        return true;
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return false;
    }
}

/// Before a program runs for nothing.
void require_writable(const std::string& file) {
    const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (made < 0)
        throw BadInput(fmt::format("--out {}: cannot be written: {}", file, std::strerror(errno)));
    ::close(made);
    fs::remove(file);
}

int run(const RecordOptions& options) {
    const fs::path library = record_library();
    if (options.program.empty())
        throw BadInput("name a program: boxwood record --out program.h5 ./program ARGUMENTS");
    if (const auto there = recordings(options.file); !there.empty())
        throw BadInput(fmt::format("{} is there already: remove it, or give another --out",
                                   there.front().string()));
    require_writable(options.file);
    // Ctrl-C is the program's, which both get.
    std::signal(SIGINT, SIG_IGN);
    const pid_t child = fork();
    if (child < 0)
        throw BadInput(fmt::format("no process can be made: {}", std::strerror(errno)));
    if (child == 0) {
        std::signal(SIGINT, SIG_DFL);
        become(options, library);
    }
    const int status = status_of(child);
    const std::vector<fs::path> files = recordings(options.file);
    bool are_whole = true;
    for (const fs::path& file : files)
        are_whole &= say_what_is_in(file);
    if (status != exit_success)
        return status;
    if (!files.empty())
        return are_whole ? exit_success : exit_failed;
    fmt::print(
        stderr,
        "boxwood record: {} called no manager of FCL's shared library in doubles. In floats, "
        "or linked statically, put a recorder into the program: trees/adapters/README.md\n",
        options.program[0]);
    return exit_failed;
}

} // namespace

void add_record(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RecordOptions>();
    CLI::App* command = app.add_subcommand(
        "record", "run a program of yours that uses FCL, as it is, and write down what it asks");
    command->add_option("--out", options->file, "where to; a file that is not there yet")
        ->capture_default_str();
    command->prefix_command();
    command->footer(
        "Usage: boxwood record [--out FILE.h5] PROGRAM [ARGUMENTS]\n"
        "The program is not changed or built again: a library is loaded before its own, which\n"
        "writes down every call to FCL's broad-phase managers (all but the spatial hash): "
        "objects,\n"
        "poses, geometries once, what callbacks were shown, their requests to fcl::collide and\n"
        "fcl::distance about two objects, times. A file for each manager, the\n"
        "second FILE-2.h5; `boxwood replay FILE.h5` runs it with every manager there is.\n"
        "It must load libfcl 0.7 (ldd PROGRAM shows it) and use doubles; others, and those with\n"
        "Boxwood's own manager, call a recorder: trees/adapters/README.md. Calls that a compiler\n"
        "puts in place are not seen (GCC puts none); children that are forked after the first\n"
        "call record nothing; of a program that is killed the last second may be lost, and what\n"
        "began after a call that was not done. No lock is held in a manager or a callback; calls "
        "are\n"
        "written in the order in which they begin.\n"
        "No Python modules that bring an FCL or HDF5 of their own.\n"
        "Examples:\n  boxwood record ./my_planner --scene kitchen.yaml\n"
        "  boxwood record --out kitchen.h5 ./my_planner\n  boxwood replay kitchen.h5\n"
        "Exit codes: the program's; 1 if nothing was recorded, or it cannot be read,\n"
        "2 bad usage, 127 no such program.");
    command->callback([command, options, &exit_code] {
        options->program = command->remaining();
        exit_code = run(*options);
    });
}

} // namespace boxwood::bench
