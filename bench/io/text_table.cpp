#include "bench/io/text_table.h"

#include "results/measured_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boxwood::bench {
namespace {

/// Code points of UTF-8; combining and wide characters do not occur in our tables.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool is_right) {
    const std::string spaces(width - std::min(width, width_of(text)), ' ');
    return is_right ? spaces + text : text + spaces;
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text)
        out += c == '|' ? "\\|" : std::string(1, c);
    return out;
}

} // namespace

TextTable::TextTable(std::vector<std::string> headings) : headings_(std::move(headings)) {
    for (std::string& heading : headings_) {
        is_right_.push_back(heading.starts_with('>'));
        if (is_right_.back())
            heading.erase(0, 1);
    }
}

void TextTable::add(std::vector<std::string> row) {
    row.resize(headings_.size());
    rows_.push_back(std::move(row));
}

std::string TextTable::text() const {
    std::vector<std::size_t> widths;
    for (std::size_t i = 0; i < headings_.size(); ++i) {
        widths.push_back(width_of(headings_[i]));
        for (const auto& row : rows_)
            widths[i] = std::max(widths[i], width_of(row[i]));
    }
    std::string out;
    const auto put = [&](const std::vector<std::string>& row) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
            line += (i > 0 ? "  " : "") + padded(row[i], widths[i], is_right_[i]);
        line.erase(line.find_last_not_of(' ') + 1);
        out += line + '\n';
    };
    put(headings_);
    for (const auto& row : rows_)
        put(row);
    return out;
}

std::string TextTable::markdown() const {
    std::string out;
    const auto put = [&](const std::vector<std::string>& row) {
        for (const std::string& cell : row)
            out += "| " + escaped(cell) + " ";
        out += "|\n";
    };
    put(headings_);
    for (const bool is_right : is_right_)
        out += is_right ? "| ---: " : "| --- ";
    out += "|\n";
    for (const auto& row : rows_)
        put(row);
    return out;
}

std::string ratio_text(double ratio) {
    if (std::isnan(ratio))
        return "-";
    const int digits = ratio >= 99.95 ? 0 : ratio >= 9.995 ? 1 : ratio >= 0.9995 ? 2 : 3;
    return fmt::format("{:.{}f}", ratio, digits);
}

std::string time_text(double ns) {
    if (std::isnan(ns))
        return "-";
    struct Unit {
        const char* name;
        double ns;
    };
    constexpr Unit units[] = {{"ns", 1}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}};
    const Unit* unit = units;
    while (unit + 1 != std::end(units) && ns >= 999.5 * unit->ns)
        ++unit;
    const double value = ns / unit->ns;
    const int digits = value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2;
    return fmt::format("{:.{}f} {}", value, digits, unit->name);
}

std::string bytes_text(std::uint64_t bytes) {
    return bytes == results::no_count ? "?"
           : bytes < (1u << 20)       ? fmt::format("{} KiB", bytes >> 10)
                                      : fmt::format("{} MiB", bytes >> 20);
}

std::string or_unknown(std::string text) { return text.empty() ? "?" : text; }

std::string spaced(std::string_view name) {
    std::string words(name);
    std::ranges::replace(words, '_', ' ');
    return words;
}

} // namespace boxwood::bench
