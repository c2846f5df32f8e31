#pragma once

#include "trees/function_ref.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace boxwood::bench {

/// What a row holds, for the reader and for its error messages.
struct CsvFormat {
    std::string_view columns;     ///< "ox,oy,oz,dx,dy,dz[,tmax]"
    std::size_t min = 0, max = 0; ///< numbers in a row
};

/// Calls row(numbers, line) for each row of `text`, in order; lines count from 1. Blank lines and
/// lines that start with # are skipped, as are spaces around numbers and CR before LF.
/// Numbers are decimal (1, -2.5, 1e-3, inf, nan) or hex floats (0x1.8p-3), rounded to nearest.
/// Throws BadInput naming source:line for anything else, and for a number beyond all doubles. A
/// text without rows is a warning on stderr.
void read_csv(std::string_view text, const std::string& source, const CsvFormat& format,
              FunctionRef<void(std::span<const double> numbers, std::size_t line)> row);

/// The warning to stderr of a text that has only blank lines and comments.
void warn_of_no_rows(const std::string& source, std::string_view columns);

/// "source:line: what" as BadInput.
[[noreturn]] void throw_bad_row(const std::string& source, std::size_t line,
                                const std::string& what);

/// The whole of a file; `-` is standard input. Throws BadInput if it cannot be read.
std::string read_text(const std::string& path);

/// What to call the path in messages: "standard input" for `-`.
std::string source_name(const std::string& path);

} // namespace boxwood::bench
