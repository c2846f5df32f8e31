#pragma once

#include "bench/tasks/contender.h"

#include <vector>

namespace boxwood::bench {

/// Embree's builders of binary trees, for the task build; made in peers/embree/embree_builder.cpp.
std::vector<ContenderEntry> embree_trees();

} // namespace boxwood::bench
