#pragma once

#include "bench/analysis/compare_files.h"
#include "bench/running/sweep.h"

#include <filesystem>

namespace boxwood::bench {

/// Where the results of the other program go: FILE.base.h5 beside FILE.h5.
std::filesystem::path base_file_of(const std::filesystem::path& out);

/// `boxwood sweep --against PROGRAM`: the rounds of this program and of an older or newer one take
/// turns, so that what the machine does meets both alike; then their files are compared. Both are
/// ordinary sweeps, which go on where they were interrupted. Gives compare's exit code; throws
/// BadInput if a program cannot do the sweep.
int run_against(const std::filesystem::path& program, const SweepOptions& options,
                const FileOptions& compared);

} // namespace boxwood::bench
