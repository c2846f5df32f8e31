#pragma once

#include "bench/tasks/contender.h"

#include <vector>

/// What the peers offer for two meshes. Each is made in a file of its peer and appended to its
/// contenders.
namespace boxwood::bench {

std::vector<ContenderEntry> fcl_meshes();
std::vector<ContenderEntry> fcl_motions(); ///< of meshes that move
std::vector<ContenderEntry> fcl_robots();  ///< self-collision
std::vector<ContenderEntry> cgal_meshes();
std::vector<ContenderEntry> bullet_meshes();

} // namespace boxwood::bench
