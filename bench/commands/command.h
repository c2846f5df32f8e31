#pragma once

#include <CLI/CLI.hpp>

#include <stdexcept>

namespace boxwood::bench {

/// Bad usage or bad input: the message says what, where and how to fix it; exit code 2.
class BadInput : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

inline constexpr int exit_success = 0;
inline constexpr int exit_failed = 1;      ///< a check or a promise failed
inline constexpr int exit_bad_input = 2;   ///< also any other exception that reaches main
inline constexpr int exit_cannot_tell = 3; ///< compare alone
inline constexpr int exit_interrupted = 130;

/// Each command adds itself: options, a help text with an example, and a callback that runs it and
/// sets `exit_code`. One file of bench/commands/ per command.
void add_list(CLI::App& app, int& exit_code);
void add_sweep(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_show(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_merge(CLI::App& app, int& exit_code);
void add_doctor(CLI::App& app, int& exit_code);
void add_demo(CLI::App& app, int& exit_code);
void add_scene(CLI::App& app, int& exit_code);
void add_plan(CLI::App& app, int& exit_code);
void add_query(CLI::App& app, int& exit_code);

} // namespace boxwood::bench
