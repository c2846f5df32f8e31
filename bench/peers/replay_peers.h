#pragma once

#include "bench/replay/replay.h"

#include <vector>

/// The managers of peers that recorded programs can be run with, and ours in their place.
namespace boxwood::bench {

std::vector<ReplayEntry> fcl_replays();
std::vector<ReplayEntry> fcl_shape_replays(); ///< with the narrow phase

/// Whether all bounds and poses are finite and nearer than 1e18. FCL's trees crash on what is
/// farther, as the bounds of a half-space are: in floats, in doubles on infinities alone.
bool are_all_near(const RecordedProgram& program);

} // namespace boxwood::bench
