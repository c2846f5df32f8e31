#pragma once

#include "kernels/primitives/aabb.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace boxwood {

/// Calls take(numbers, place) for each row of a CSV file of `min` to `max` finite numbers; blank
/// lines and those that begin with # are skipped. place is "file:line", for messages. Throws
/// std::runtime_error, "file:line: a row is COLUMNS", for another row, and for a file that cannot
/// be read or has none.
void read_rows(const std::filesystem::path& file, std::string_view columns, std::size_t min,
               std::size_t max,
               const std::function<void(std::span<const double>, const std::string& place)>& take);

/// As a float. Throws std::runtime_error, "place: ...", for a number that a float does not hold.
float as_float(double number, const std::string& place);

/// Of min_x, min_y, min_z, max_x, max_y, max_z, rounded to floats. Throws so for a min above its
/// max, too.
Aabb<float> box_of(std::span<const double, 6> numbers, const std::string& place);

} // namespace boxwood
