#pragma once

#include "results/results.h"

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>

namespace boxwood::bench {

inline constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

/// What a run found, on one screen: at most `max_lines` lines of 100 columns, and a few more where
/// there is a device. Whether it can be believed, how many answers were wrong, the headlines of
/// /findings, losses first, and the sizes of one scene on the device; of a run with too much noise
/// that it must be repeated. Reads the derived tables, derives nothing.
std::string screen_text(const results::Results& results, std::size_t max_lines = 21);

/// A line for each row of /device_gains, at most `max_rows`; empty without one.
std::string devices_text(const results::Results& results, std::size_t max_rows = no_limit);

/// All findings, by topic.
std::string findings_text(const results::Results& results);

/// A result file, and its report and figures where they stand beside it: at most four lines.
std::string paths_text(const std::filesystem::path& file);

} // namespace boxwood::bench
