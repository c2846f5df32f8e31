#pragma once

#include "bench/analysis/run_index.h"

#include <string>

namespace boxwood::bench {

/// Several threads against one: the time of the cell on one thread over that on more, phase by
/// phase, of every tree and of what is best of ours at something. Empty if nothing ran on both.
std::string speed_ups_text(const RunIndex& index);

} // namespace boxwood::bench
