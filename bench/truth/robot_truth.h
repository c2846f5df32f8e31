#pragma once

#include "bench/truth/truth.h"

namespace boxwood::bench {

/// In which states of a scene's robot two links touch that must not: by rational arithmetic on the
/// triangles of all such pairs of links, whose corners are rounded to doubles in the root's frame.
/// Meshes are surfaces, other shapes solids (link_solid.h); where round ones are so near to another
/// that the polyhedra in them are apart and those around them touch, both answers are right.
/// Nothing of trees/world/ is in it.
std::unique_ptr<Truth> make_robot_truth(const Scene& scene, unsigned threads);

/// How far apart the two nearest links are that must not touch, and which they are: between the
/// least distances of the polyhedra in the links and of those around them (nearest_triangles.h), up
/// to 2^-44 of the largest coordinate, by which poses are rounded. The named links must be as far
/// apart as is said, and [lo, hi] no wider than 2^-20 of hi.
std::unique_ptr<Truth> make_robot_distance_truth(const Scene& scene, unsigned threads);

} // namespace boxwood::bench
