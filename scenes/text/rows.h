#pragma once

#include "kernels/primitives/aabb.h"
#include "scenes/text/csv.h"

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace boxwood {

/// Calls take(numbers, place) for each row of a CSV file (read_csv); place is "file:line", for
/// messages. Throws BadInput as read_csv does, and for a file that cannot be read or has no row.
void read_rows(const std::filesystem::path& file, const CsvFormat& format,
               const std::function<void(std::span<const double>, const std::string& place)>& take);

/// Of min_x, min_y, min_z, max_x, max_y, max_z, rounded to floats. Throws BadInput, "place: ...",
/// for a number that a float does not hold, and for a min above its max.
Aabb<float> box_of(std::span<const double, 6> numbers, const std::string& place);

} // namespace boxwood
