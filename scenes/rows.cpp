#include "scenes/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <vector>

namespace boxwood {
namespace {

/// The number that begins `text`, behind blanks, and is taken from it. False if there is none.
bool take_number(std::string_view& text, double& number) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{})
        return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
    return true;
}

/// False if it is no row of numbers.
bool read_row(std::string_view row, std::vector<double>& numbers) {
    numbers.clear();
    for (;;) {
        if (!take_number(row, numbers.emplace_back()))
            return false;
        if (row.empty())
            return true;
        if (!row.starts_with(','))
            return false;
        row.remove_prefix(1);
    }
}

} // namespace

void read_rows(const std::filesystem::path& file, std::string_view columns, std::size_t min,
               std::size_t max,
               const std::function<void(std::span<const double>, const std::string& place)>& take) {
    std::ifstream in(file);
    std::vector<double> numbers;
    std::size_t lines = 0, rows = 0;
    for (std::string line; std::getline(in, line);) {
        const std::string place = fmt::format("{}:{}", file.string(), ++lines);
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string::npos || line[first] == '#')
            continue;
        if (!read_row(line, numbers) || numbers.size() < min || numbers.size() > max)
            throw std::runtime_error(fmt::format("{}: a row is {}", place, columns));
        ++rows;
        take(numbers, place);
    }
    if (in.bad() || lines == 0)
        throw std::runtime_error(fmt::format("{}: cannot read it, or it is empty", file.string()));
    if (rows == 0)
        throw std::runtime_error(fmt::format("{}: it holds no rows of {}", file.string(), columns));
}

float as_float(double number, const std::string& place) {
    if (!(std::abs(number) <= static_cast<double>(std::numeric_limits<float>::max())))
        throw std::runtime_error(place + ": coordinates must be numbers that a float holds");
    return static_cast<float>(number);
}

Aabb<float> box_of(std::span<const double, 6> numbers, const std::string& place) {
    Aabb<float> box;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = numbers[static_cast<std::size_t>(axis)];
        const double high = numbers[static_cast<std::size_t>(axis) + 3];
        box.min[axis] = as_float(low, place);
        box.max[axis] = as_float(high, place);
        if (low > high)
            throw std::runtime_error(fmt::format("{}: min {} is above max {}", place, low, high));
    }
    return box;
}

} // namespace boxwood
