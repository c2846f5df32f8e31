#pragma once

#include "results/results.h"

#include <filesystem>

namespace boxwood::bench {

/// Reads a result file that a user named: says on stderr, in one line, if another program changed
/// it after it was written.
results::Results read_results(const std::filesystem::path& file,
                              results::Required required = results::Required::all);

} // namespace boxwood::bench
