#pragma once

#include "bench/io/bad_input.h"

namespace CLI {
class App;
}

namespace boxwood::bench {

/// Each command adds itself: options, a help text with an example, and a callback that runs it and
/// sets `exit_code`. One file of bench/commands/ per command.
void add_list(CLI::App& app, int& exit_code);
void add_sweep(CLI::App& app, int& exit_code);
void add_choose(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_show(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_merge(CLI::App& app, int& exit_code);
void add_doctor(CLI::App& app, int& exit_code);
void add_demo(CLI::App& app, int& exit_code);
void add_scene(CLI::App& app, int& exit_code);
void add_plan(CLI::App& app, int& exit_code);
void add_explain(CLI::App& app, int& exit_code);
void add_grade(CLI::App& app, int& exit_code);
void add_query(CLI::App& app, int& exit_code);
void add_record(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);

} // namespace boxwood::bench
