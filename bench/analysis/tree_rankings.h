#pragma once

#include "bench/analysis/run_index.h"

#include <string>

namespace boxwood::bench {

/// Trees alone: each build with its time and SAH cost, ours with the ratios of both to each peer.
/// Empty if nothing asked for trees.
std::string tree_rankings_text(const RunIndex& index);

/// Builds for rays: the time of each tree of ours against the peer's, beside the worst of what its
/// rays do over all that was asked of that mesh. Empty if no peer walked rays.
std::string ray_builds_text(const RunIndex& index);

} // namespace boxwood::bench
