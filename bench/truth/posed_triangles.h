#pragma once

#include "bench/truth/nearest_triangles.h"
#include "kernels/primitives/rigid_transform.h"
#include "scenes/scene.h"
#include "trees/queries/sinks.h"

#include <cstddef>
#include <vector>

/// A mesh and its copy in the poses of a scene, for judges: corners in doubles, as the pose gives
/// them.
namespace boxwood::bench {

using PosedTriangles = std::vector<Triangle<double>>;

Triangle<double> triangle_at(const TriangleMesh& mesh, std::size_t i,
                             const RigidTransform<double>& pose);
PosedTriangles triangles_at(const TriangleMesh& mesh, const RigidTransform<double>& pose);

/// The pairs of triangles of two sides that share a point, ascending, by rational arithmetic on all
/// whose boxes overlap, which a sweep finds without a tree.
std::vector<Pair> touching_pairs(const PosedTriangles& a, const PosedTriangles& b,
                                 unsigned threads);

/// The least distance in each pose of the scene.
std::vector<NearestTriangles::Least> least_distances(const Scene& scene, unsigned threads);

/// The greatest |coordinate| of a mesh's triangles.
double size_of(const PosedTriangles& mesh);

} // namespace boxwood::bench
