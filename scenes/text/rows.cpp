#include "scenes/text/rows.h"

#include "scenes/text/read_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace boxwood {
namespace {

float as_float(double number, const std::string& place) {
    if (!(std::abs(number) <= static_cast<double>(std::numeric_limits<float>::max())))
        throw BadInput(place + ": coordinates must be numbers that a float holds");
    return static_cast<float>(number);
}

} // namespace

void read_rows(const std::filesystem::path& file, const CsvFormat& format,
               const std::function<void(std::span<const double>, const std::string& place)>& take) {
    const std::string source = file.string();
    const auto with_place = [&](std::span<const double> numbers, std::size_t line) {
        take(numbers, fmt::format("{}:{}", source, line));
    };
    if (read_csv(read_file(file), source, format, with_place) == 0)
        throw BadInput(fmt::format("{}: it holds no rows of {}", source, format.columns));
}

Aabb<float> box_of(std::span<const double, 6> numbers, const std::string& place) {
    Aabb<float> box;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = numbers[static_cast<std::size_t>(axis)];
        const double high = numbers[static_cast<std::size_t>(axis) + 3];
        box.min[axis] = as_float(low, place);
        box.max[axis] = as_float(high, place);
        if (low > high)
            throw BadInput(fmt::format("{}: min {} is above max {}", place, low, high));
    }
    return box;
}

} // namespace boxwood
