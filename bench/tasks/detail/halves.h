#pragma once

#include <cstddef>

namespace boxwood::bench {

/// The items of the task tree_pairs: boxes [0, n/2) against [n/2, n). In its answers a < n/2 <= b,
/// both indices of the whole scene.
inline std::size_t tree_pairs_split(std::size_t n) { return n / 2; }

} // namespace boxwood::bench
