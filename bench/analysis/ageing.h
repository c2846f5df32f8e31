#pragma once

#include "bench/analysis/run_index.h"

#include <string>

namespace boxwood::bench {

/// How the trees of moving scenes age, counted and so the same on every machine: the box tests of
/// the last frame's query over those of the first, and the same of Updater::sah. Of every policy
/// with ten frames or more; in brief of auto, and of each scene what ages most. Empty if nothing
/// was counted.
std::string ageing_text(const RunIndex& index, bool brief);

} // namespace boxwood::bench
