#pragma once

#include "bench/tasks/contender.h"

#include <vector>

namespace boxwood::bench {

/// Embree's rays: one at a time, in packets of 8 and 16, in streams, and every hit; made in
/// peers/embree_rays.cpp.
std::vector<ContenderEntry> embree_rays();

} // namespace boxwood::bench
