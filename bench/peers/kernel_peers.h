#pragma once

#include "bench/tasks/contender.h"

#include <vector>

/// The peers' kernels: what each library offers for one pair of primitives, beside its trees. Each
/// is made in peers/NAME/NAME_kernels.cpp (convex shapes: NAME_shapes.cpp) and appended to the
/// contenders of its peer.
namespace boxwood::bench {

std::vector<ContenderEntry> fcl_kernels();
std::vector<ContenderEntry> cgal_kernels();
std::vector<ContenderEntry> embree_kernels();
std::vector<ContenderEntry> bullet_kernels();
std::vector<ContenderEntry> fcl_shapes();
std::vector<ContenderEntry> bullet_shapes();

} // namespace boxwood::bench
