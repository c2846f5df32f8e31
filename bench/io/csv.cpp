#include "bench/io/csv.h"

#include "bench/io/bad_input.h"
#include "bench/io/fields.h"
#include "bench/io/say.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>

namespace boxwood::bench {
namespace {

constexpr std::size_t max_columns = 32;

enum class Fault { none, not_a_number, too_large };

Fault parse(std::string_view text, double& value) {
    bool negative = false;
    if (!text.empty() && (text.front() == '+' || text.front() == '-')) {
        negative = text.front() == '-';
        text.remove_prefix(1);
    }
    const bool hex = text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    if (hex)
        text.remove_prefix(2);
    if (text.empty() || text.front() == '+' || text.front() == '-') // from_chars would take -
        return Fault::not_a_number;

    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(
        text.data(), end, value, hex ? std::chars_format::hex : std::chars_format::general);
    if (error == std::errc::invalid_argument || stop != end)
        return Fault::not_a_number;
    if (error == std::errc::result_out_of_range) {
        // from_chars leaves the value alone, be it too large or too small; strtod tells which, and
        // rounds what is small to a subnormal or zero. No locale is ever set.
        value = std::strtod(((hex ? "0x" : "") + std::string(text)).c_str(), nullptr);
        if (std::isinf(value))
            return Fault::too_large;
    }
    if (negative)
        value = -value;
    return Fault::none;
}

} // namespace

void throw_bad_row(const std::string& source, std::size_t line, const std::string& what) {
    throw BadInput(fmt::format("{}:{}: {}", source, line, what));
}

void read_csv(std::string_view text, const std::string& source, const CsvFormat& format,
              FunctionRef<void(std::span<const double>, std::size_t)> row) {
    text = without_byte_order_mark(text);
    std::array<double, max_columns> numbers;
    std::size_t n_rows = 0;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::string_view whole = trimmed(take_until(text, '\n'));
        if (whole.empty() || whole.front() == '#')
            continue;

        std::size_t n = 0;
        std::string_view rest = whole;
        for (bool more = true; more; ++n) {
            more = rest.find(',') != std::string_view::npos;
            const std::string_view field = trimmed(take_until(rest, ','));
            if (n >= format.max)
                continue; // only counted
            switch (parse(field, numbers[n])) {
            case Fault::none:
                break;
            case Fault::not_a_number:
                if (field.find('#') != std::string_view::npos)
                    throw_bad_row(source, line,
                                  "a comment stands behind numbers; put it on a line of its own");
                if (field.find('\r') != std::string_view::npos)
                    throw_bad_row(source, line,
                                  "lines end in carriage returns alone; end them in line feeds");
                throw_bad_row(
                    source, line,
                    fmt::format("column {} is {}; expected numbers {}, with commas "
                                "between (put # before a header line)",
                                n + 1,
                                field.empty() ? "empty" : bench::quoted(field) + ", not a number",
                                format.columns));
            case Fault::too_large:
                throw_bad_row(source, line,
                              fmt::format("column {} is {}, larger than every double", n + 1,
                                          bench::quoted(field)));
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
    if (n_rows == 0)
        warn_of_no_rows(source, format.columns);
}

void warn_of_no_rows(const std::string& source, std::string_view columns) {
    say(fmt::format("boxwood: warning: {} holds no rows of {}\n", source, columns));
}

std::string source_name(const std::string& path) { return path == "-" ? "standard input" : path; }

std::string read_text(const std::string& path) {
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Close> owned;
    std::FILE* file = stdin;
    const auto fail = [&] {
        throw BadInput(
            fmt::format("{}: cannot read it: {}", source_name(path), std::strerror(errno)));
    };
    if (path != "-") {
        owned.reset(std::fopen(path.c_str(), "rb"));
        if (!owned)
            fail();
        file = owned.get();
    }
    std::string text;
    for (std::size_t got = 1; got != 0;) {
        const std::size_t size = text.size();
        text.resize(size + (std::size_t{1} << 20));
        got = std::fread(text.data() + size, 1, text.size() - size, file);
        text.resize(size + got);
    }
    if (std::ferror(file))
        fail();
    return text;
}

} // namespace boxwood::bench
