#pragma once

#include "bench/analysis/run_index.h"

#include <string>

namespace boxwood::bench {

/// "Everything on" against "only what is called for", by update and query of a frame: the same
/// answers of the same scene. Empty if no scene was played both ways.
std::string everything_text(const RunIndex& index);

/// What each effect adds to a frame: the scene with it against the same scene without it.
std::string effect_prices_text(const RunIndex& index);

} // namespace boxwood::bench
