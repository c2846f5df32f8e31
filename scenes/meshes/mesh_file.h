#pragma once

#include "kernels/primitives/triangle.h"

#include <filesystem>

namespace boxwood {

/// All triangles of a file that assimp reads (OBJ, PLY, STL, ...), in file order: node transforms
/// applied, polygons cut, points and lines dropped, vertices at equal coordinates made one.
/// Next to larger polygons a triangle may start at another of its corners, winding the same way.
/// Text STL coordinates may be an ulp off; all others are exact or rounded to nearest.
/// Throws std::runtime_error naming the file, and the line or element where it is known, for one
/// that is missing, unreadable, truncated, of no known format, without triangles, or that holds a
/// coordinate that is no finite float or a vertex index out of range.
TriangleMesh load_mesh(const std::filesystem::path& file);

} // namespace boxwood
