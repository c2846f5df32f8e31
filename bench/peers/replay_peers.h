#pragma once

#include "bench/replay/replay.h"

#include <vector>

/// The managers of peers that recorded programs can be run with, and ours in their place.
namespace boxwood::bench {

std::vector<ReplayEntry> fcl_replays();
std::vector<ReplayEntry> fcl_shape_replays(); ///< with the narrow phase

} // namespace boxwood::bench
