#pragma once

#include "bench/plan/block_reader.h"
#include "bench/tasks/contender.h"

namespace boxwood::bench {

/// The class of contenders that answer a frame with the pairs of earlier ones, corrected. All
/// others find the pairs of each frame again, and are never compared with these. Ours are
/// in it where they did so in any frame.
inline const std::string cached_pairs_class = "cached pairs";

/// The contender "<policy>[_<setting><value>...].packed.self_pairs" of moving_pairs. Throws
/// std::invalid_argument, with a suggestion, for an unknown name.
ContenderEntry moving_contender(const BuilderChoice& policy);

} // namespace boxwood::bench
