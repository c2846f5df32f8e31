#pragma once

#include "bench/analysis/run_index.h"

#include <string>

namespace boxwood::bench {

/// How much longer than the best fixed policy `auto` may take on a scene.
inline constexpr double auto_may_lose = 0.10;

/// The policies `auto` and `cached` against the best other fixed one of each moving scene, by update
/// and query of a frame together. Empty if no scene has two policies.
std::string policies_text(const RunIndex& index);

} // namespace boxwood::bench
