#pragma once

#include "kernels/triangle.h"

#include <filesystem>

namespace boxwood {

/// Reads a mesh through assimp (OBJ, PLY, STL and whatever else it was built with): all meshes of
/// the file joined in file order, node transforms applied, polygons cut into triangles, points and
/// lines dropped, vertices at the same coordinates made one. In a file with larger polygons a
/// triangle may start at another of its corners (winding and order stay).
/// Throws std::runtime_error naming the file, and the line or element where it can be told, for: no
/// such file, a folder, no permission, an unknown format, a truncated or garbled file, no
/// triangles, a coordinate that is NaN, infinite or too large for a float, a vertex index out of
/// range.
TriangleMesh load_mesh(const std::filesystem::path& file);

} // namespace boxwood
