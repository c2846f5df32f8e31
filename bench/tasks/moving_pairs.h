#pragma once

#include "bench/plan/block_reader.h"
#include "bench/tasks/contender.h"

namespace boxwood::bench {

/// The contender "<policy>[_<setting><value>...].packed.self_pairs" of moving_pairs. Throws
/// std::invalid_argument, with a suggestion, for an unknown name.
ContenderEntry moving_contender(const BuilderChoice& policy);

} // namespace boxwood::bench
