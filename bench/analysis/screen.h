#pragma once

#include "results/results.h"

#include <filesystem>
#include <string>

namespace boxwood::bench {

/// What a run found, on one screen: at most `max_lines` lines of 100 columns. Whether it can be
/// believed, how many answers were wrong, and the headlines of /findings, losses first; of a run
/// with too much noise that it must be repeated. Reads the derived tables, derives nothing.
std::string screen_text(const results::Results& results, std::size_t max_lines = 21);

/// All findings, by topic.
std::string findings_text(const results::Results& results);

/// A result file, and its report and figures where they stand beside it: at most four lines.
std::string paths_text(const std::filesystem::path& file);

} // namespace boxwood::bench
