#include "bench/io/csv.h"

#include "bench/io/say.h"
#include "scenes/text/read_file.h"

#include <fmt/format.h>

namespace boxwood::bench {

void read_csv_input(const std::string& path, const CsvFormat& format,
                    const std::function<void(std::span<const double>, std::size_t)>& row) {
    const std::string source = source_name(path);
    if (read_csv(read_text(path), source, format, row) == 0)
        warn_of_no_rows(source, format.columns);
}

void warn_of_no_rows(const std::string& source, std::string_view columns) {
    say(fmt::format("boxwood: warning: {} holds no rows of {}\n", source, columns));
}

std::string source_name(const std::string& path) { return path == "-" ? "standard input" : path; }

std::string read_text(const std::string& path) {
    return path == "-" ? read_stream(stdin, source_name(path)) : read_file(path);
}

} // namespace boxwood::bench
