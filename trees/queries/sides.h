#pragma once

#include "kernels/primitives/triangle.h"
#include "trees/layout.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace boxwood {

/// Where a point is as a closed mesh sees it.
enum class Side : std::uint8_t { outside, on_surface, inside };

/// How many edges have an odd number of triangles, vertices at one place taken for one: 0 of a
/// closed mesh.
std::size_t open_edges(const TriangleMesh& mesh);

/// out[i] answers points[i], exactly: also where a point is in line with edges and vertices. Inside
/// by the even-odd rule, which asks for no orientation; where two parts of a mesh overlap is
/// outside. The mesh is closed, and `layout` is of the boxes of its triangles; a point that is not
/// finite is outside. out.size() == points.size(), else std::invalid_argument.
void sides(const AnyLayout& layout, const TriangleMesh& mesh, std::span<const Vec3<float>> points,
           const Executor& executor, std::span<Side> out);

} // namespace boxwood
