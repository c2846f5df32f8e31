#include "scenes/text/csv.h"

#include "scenes/text/fields.h"
#include "scenes/text/number.h"

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <utility>

namespace boxwood {
namespace {

constexpr std::size_t max_columns = 32;

/// Whether a line names the columns, in order, and as many as a row may have.
bool is_header(std::string_view line, const CsvFormat& format) {
    std::string names(format.columns);
    std::erase_if(names, [](char c) { return c == '[' || c == ']'; });
    std::string_view known = names;
    std::size_t n = 0;
    for (bool more = true; more; ++n) {
        more = line.find(',') != std::string_view::npos;
        std::string_view field = trimmed(take_until(line, ','));
        if (field.size() > 1 && field.front() == '"' && field.back() == '"')
            field = field.substr(1, field.size() - 2);
        if (known.empty() || field.empty() || field != trimmed(take_until(known, ',')))
            return false;
    }
    return n >= format.min && n <= format.max;
}

} // namespace

void throw_bad_row(const std::string& source, std::size_t line, const std::string& what) {
    throw BadInput(fmt::format("{}:{}: {}", source, line, what));
}

std::size_t read_csv(std::string_view text, const std::string& source, const CsvFormat& format,
                     const std::function<void(std::span<const double>, std::size_t)>& row) {
    assert(format.max <= max_columns);
    text = without_byte_order_mark(text);
    std::array<double, max_columns> numbers;
    std::size_t n_rows = 0;
    bool is_first = true;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::string_view whole = trimmed(take_until(text, '\n'));
        if (whole.empty() || whole.front() == '#')
            continue;
        if (std::exchange(is_first, false) && is_header(whole, format))
            continue;

        std::size_t n = 0;
        std::string_view rest = whole;
        for (bool more = true; more; ++n) {
            more = rest.find(',') != std::string_view::npos;
            const std::string_view field = trimmed(take_until(rest, ','));
            if (n >= format.max)
                continue; // only counted
            switch (parse_number(field, numbers[n])) {
            case NumberFault::none:
                break;
            case NumberFault::not_a_number:
                if (field.find('#') != std::string_view::npos)
                    throw_bad_row(source, line,
                                  "a comment stands behind numbers; put it on a line of its own");
                if (field.find('\r') != std::string_view::npos)
                    throw_bad_row(source, line,
                                  "lines end in carriage returns alone; end them in line feeds");
                throw_bad_row(
                    source, line,
                    fmt::format("column {} is {}; expected numbers {}, with commas "
                                "between (put # before other header lines)",
                                n + 1, field.empty() ? "empty" : quoted(field) + ", not a number",
                                format.columns));
            case NumberFault::too_large:
                throw_bad_row(
                    source, line,
                    fmt::format("column {} is {}, larger than every double", n + 1, quoted(field)));
            }
        }
        if (n < format.min || n > format.max)
            throw_bad_row(source, line,
                          fmt::format("{} column{}, expected {}: {}", n, n == 1 ? "" : "s",
                                      format.min == format.max
                                          ? fmt::format("{}", format.min)
                                          : fmt::format("{} to {}", format.min, format.max),
                                      format.columns));
        row({numbers.data(), n}, line);
        ++n_rows;
    }
    return n_rows;
}

} // namespace boxwood
