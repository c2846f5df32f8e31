#pragma once

#include "bench/tasks/contender.h"

#include <vector>

namespace boxwood::bench {

/// FCL's contenders for two meshes (fcl_meshes.cpp).
std::vector<ContenderEntry> fcl_meshes();

} // namespace boxwood::bench
