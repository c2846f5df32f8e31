#pragma once

namespace boxwood::bench {

/// The `boxwood` command: finds the subcommand, and turns whatever goes wrong into one line on
/// stderr and the exit code that bench/io/bad_input.h names.
int run_program(int argc, char** argv);

} // namespace boxwood::bench
