#pragma once

#include "scenes/text/bad_input.h"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace boxwood {

/// What a row holds, for the reader and for its error messages.
struct CsvFormat {
    std::string_view columns;     ///< "ox,oy,oz,dx,dy,dz[,tmax]"; a first line of these is a header
    std::size_t min = 0, max = 0; ///< numbers in a row; 32 at most
};

/// Calls row(numbers, line) for each row of `text`, in order, and says how many there were; lines
/// count from 1. Blank lines and lines that start with # are skipped, as are spaces around numbers,
/// CR before LF, a byte order mark, and a first line that names the columns. Numbers are those of
/// parse_number (number.h). Throws BadInput naming source:line for anything else, and for a number
/// beyond all doubles.
std::size_t
read_csv(std::string_view text, const std::string& source, const CsvFormat& format,
         const std::function<void(std::span<const double> numbers, std::size_t line)>& row);

/// "source:line: what" as BadInput.
[[noreturn]] void throw_bad_row(const std::string& source, std::size_t line,
                                const std::string& what);

} // namespace boxwood
