#pragma once

#include "scenes/text/csv.h"

#include <functional>
#include <span>
#include <string>

namespace boxwood::bench {

/// Calls row(numbers, line) for each row of a file, or of standard input for `-`, as read_csv does.
/// Throws BadInput. A file without rows is a warning on stderr.
void read_csv_input(const std::string& path, const CsvFormat& format,
                    const std::function<void(std::span<const double>, std::size_t line)>& row);

/// The warning to stderr of a text that has only blank lines and comments.
void warn_of_no_rows(const std::string& source, std::string_view columns);

/// The whole of a file; `-` is standard input. Throws BadInput if it cannot be read.
std::string read_text(const std::string& path);

/// What to call the path in messages: "standard input" for `-`.
std::string source_name(const std::string& path);

} // namespace boxwood::bench
