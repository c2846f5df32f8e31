#pragma once

namespace boxwood {

/// Coordinates, sizes, margins and tolerances of meshes, bodies and robots are below it: products
/// of two of them are finite in floats.
inline constexpr double coordinate_limit = 0x1p60;

} // namespace boxwood
