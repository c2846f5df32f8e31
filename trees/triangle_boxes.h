#pragma once

#include "kernels/primitives/triangle.h"
#include "trees/buffer.h"
#include "trees/executor.h"
#include "trees/tree.h"

namespace boxwood {

/// The boxes of a mesh's triangles, in their order: what a tree of triangles is built of. Throws
/// std::invalid_argument for a triangle with a vertex that is not there and InvalidBox for one with
/// a coordinate that is not finite, the first of them.
Buffer<Box> triangle_boxes(const TriangleMesh& mesh, const Executor& executor);

} // namespace boxwood
