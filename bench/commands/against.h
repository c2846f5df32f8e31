#pragma once

#include "bench/analysis/compare_files.h"
#include "bench/running/sweep.h"

#include <filesystem>

namespace boxwood::bench {

/// `boxwood sweep --against PROGRAM`: sweep_in_turns; then both files are compared. Gives compare's
/// exit code, or exit_interrupted. Throws BadInput if a program cannot do the sweep.
int run_against(const std::filesystem::path& program, const SweepOptions& options,
                const FileOptions& compared);

} // namespace boxwood::bench
