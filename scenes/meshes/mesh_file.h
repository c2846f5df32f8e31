#pragma once

#include "kernels/primitives/triangle.h"

#include <cstdint>
#include <filesystem>

namespace boxwood {

/// What becomes of triangles with a coordinate that is no finite float.
enum class NotFinite : std::uint8_t { refuse, keep };

/// All triangles of a file that assimp reads (OBJ, PLY, STL, ...), in file order: node transforms
/// applied, polygons cut, points and lines dropped, vertices at equal coordinates made one.
/// Next to larger polygons a triangle may start at another of its corners, winding the same way.
/// Text STL coordinates may be an ulp off; all others are exact or rounded to nearest.
/// Throws std::runtime_error naming the file, and the line or element where it is known, for one
/// that is missing, unreadable, truncated, of no known format, without triangles, or that holds a
/// vertex index out of range or, unless it is to be kept, a coordinate that is no finite float.
TriangleMesh load_mesh(const std::filesystem::path& file, NotFinite not_finite = NotFinite::refuse);

} // namespace boxwood
