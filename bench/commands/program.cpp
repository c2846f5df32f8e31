#include "bench/commands/program.h"

#include "bench/commands/command.h"
#include "bench/io/say.h"
#include "bench/machine/environment.h"
#include "bench/tasks/instruction_sets.h"
#include "kernels/suggest.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cfenv>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

constexpr const char* overview =
    "Trees of axis-aligned boxes (BVH) for broad phase and rays, triangle kernels for narrow "
    "phase,\n"
    "and a bench that times them and checks their answers beside FCL, Embree, CGAL and Bullet.";

constexpr const char* examples =
    "Start here:\n"
    "  boxwood demo four-link              a tree explained step by step, on a small robot\n"
    "  boxwood query pairs boxes.csv       which of your own boxes overlap\n"
    "  boxwood check --quick               every kernel, ours and the peers', on hard cases\n"
    "  boxwood doctor                      what on this machine would spoil timings\n"
    "  boxwood sweep --config bench/configs/quick.toml --out quick.h5\n"
    "                                      time trees and kernels and check their answers; a "
    "minute\n"
    "  boxwood list                        builders, layouts, kernels, scenes, peers ...\n"
    "\n"
    "`boxwood COMMAND --help` explains a command with an example.\n"
    "Exit codes: 0 success, 1 a check failed, 2 bad usage or input, 3 compare cannot tell,\n"
    "130 interrupted.";

std::string version_text() {
    std::string text =
        fmt::format("boxwood {}\ncommit    {}\ncompiler  {}, {}{}\nisa       {}\n", version(),
                    git_commit(), compiler(), build_type(),
                    sanitizers().empty() ? "" : fmt::format(", {}", sanitizers()), isa_used());
    const char* label = "packages ";
    for (const auto& [name, number] : packages()) {
        text += fmt::format("{} {} {}\n", label, name, number);
        label = "         ";
    }
    text.pop_back(); // CLI11 ends the line
    return text;
}

/// The commands of a command. Hidden ones, in no group, are for the program itself.
std::vector<std::string_view> command_names(CLI::App& app, bool also_hidden = true) {
    std::vector<std::string_view> names;
    for (const CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
        if (also_hidden || !command->get_group().empty())
            names.push_back(command->get_name());
    return names;
}

/// Throws BadInput, with a suggestion, if the command line starts with commands that do not exist.
/// CLI11 would only call them unexpected.
void require_known_commands(CLI::App& app, int argc, char** argv) {
    CLI::App* at = &app;
    for (int i = 1; i < argc && *argv[i] != '-'; ++i) {
        const auto names = command_names(*at);
        if (names.empty())
            return;
        if (std::find(names.begin(), names.end(), argv[i]) == names.end())
            throw BadInput(unknown_name(at == &app ? "command" : at->get_name() + " command",
                                        argv[i], command_names(*at, false)));
        at = at->get_subcommand(argv[i]);
    }
}

/// "boxwood query pairs": the innermost command that was named.
CLI::App* innermost(CLI::App& app, std::string& path) {
    CLI::App* at = &app;
    path = app.get_name();
    while (!at->get_subcommands().empty()) {
        at = at->get_subcommands().front();
        path += " " + at->get_name();
    }
    return at;
}

/// The error message for a command line that CLI11 refuses.
std::string complaint(CLI::App& app, const CLI::ParseError& error) {
    std::string path, text = error.what();
    CLI::App* command = innermost(app, path);
    const auto below = command_names(*command);
    if (!below.empty() && command != &app)
        return fmt::format("`{}` needs one of: {}", path, fmt::join(below, ", "));
    const std::vector<std::string> extra = app.remaining(true);
    if (!extra.empty() && extra.front().starts_with("-")) {
        std::vector<std::string> names;
        for (const CLI::Option* option : command->get_options())
            for (const std::string& name : option->get_lnames())
                names.push_back("--" + name);
        const std::vector<std::string_view> known(names.begin(), names.end());
        text = unknown_name("option", extra.front().substr(0, extra.front().find('=')), known);
    }
    return fmt::format("{} (`{} --help` explains it)", text, path);
}

int run(int argc, char** argv) {
    CLI::App app(overview, "boxwood");
    int exit_code = exit_success;
    app.set_version_flag("--version", version_text, "version, commit, compiler and packages");
    app.footer(examples);
    app.require_subcommand(0, 1);
    app.get_formatter()->column_width(32);
    add_list(app, exit_code);
    add_sweep(app, exit_code);
    add_choose(app, exit_code);
    add_check(app, exit_code);
    add_show(app, exit_code);
    add_compare(app, exit_code);
    add_merge(app, exit_code);
    add_explain(app, exit_code);
    add_grade(app, exit_code);
    add_doctor(app, exit_code);
    add_demo(app, exit_code);
    add_scene(app, exit_code);
    add_plan(app, exit_code);
    add_query(app, exit_code);
    add_record(app, exit_code);
    add_replay(app, exit_code);

    if (argc < 2) {
        std::cerr << app.help();
        return exit_bad_input;
    }
    require_known_commands(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) { // --help, --version
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        throw BadInput(complaint(app, error));
    }
    return exit_code;
}

int fail(const std::string& what) {
    std::fflush(stdout);
    say("boxwood: error: " + what + "\n");
    return exit_bad_input;
}

/// Whether nobody reads our output any more (`boxwood list | head -1`).
bool reader_has_left() {
    pollfd out{STDOUT_FILENO, POLLOUT, 0};
    return poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

/// What was printed must have been written: a full disk is an error, a reader who stops early is
/// not.
int finish(int exit_code) {
    std::cout.flush();
    const bool written = std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout.good();
    if (written || reader_has_left())
        return exit_code;
    return fail("standard output: cannot write it all: is the disk full?");
}

/// Rounding to nearest, denormals kept, no traps, in this thread and in those that it starts: a
/// library that was loaded before us may have set something else.
class DefaultFloatMode {
  public:
    DefaultFloatMode() {
        std::fegetenv(&before_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~DefaultFloatMode() { std::fesetenv(&before_); }
    DefaultFloatMode(const DefaultFloatMode&) = delete;
    DefaultFloatMode& operator=(const DefaultFloatMode&) = delete;

  private:
    std::fenv_t before_;
};

} // namespace

int run_program(int argc, char** argv) {
    const DefaultFloatMode float_mode;
    // A write to a closed pipe then fails, and `finish` decides what that means.
    std::signal(SIGPIPE, SIG_IGN);
    // So does a write beyond the limit of `ulimit -f`.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        return finish(run(argc, argv));
    } catch (const Interrupted& interrupted) {
        say(std::string("boxwood: ") + interrupted.what() + "\n");
        return exit_interrupted;
    } catch (const std::bad_alloc&) {
        return fail("not enough memory");
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}

} // namespace boxwood::bench
