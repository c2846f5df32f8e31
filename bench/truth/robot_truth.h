#pragma once

#include "bench/truth/truth.h"

namespace boxwood::bench {

/// In which states of a scene's robot two links touch that must not: by rational arithmetic on the
/// triangles of all such pairs of links, whose corners are rounded to doubles in the root's frame.
/// Meshes are surfaces, other shapes solids (link_solid.h); where round ones are so near to another
/// that the polyhedra in them are apart and those around them touch, both answers are right.
/// Nothing of trees/world/ is in it.
std::unique_ptr<Truth> make_robot_truth(const Scene& scene, unsigned threads);

} // namespace boxwood::bench
