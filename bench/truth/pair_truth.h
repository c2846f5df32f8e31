#pragma once

#include "bench/truth/truth.h"

namespace boxwood::bench {

enum class PairsOf : std::uint8_t {
    all_boxes,  ///< of a scene that overlap
    two_halves, ///< those of both sides of tree_pairs_split
    triangles   ///< of its mesh that share a point
};

/// The right pairs, by an oracle that uses no tree: brute force, or a sweep by columns beyond
/// 20,000 boxes; rational arithmetic for triangles. Holds number and hash of the pairs; which they
/// are is found again where an answer differs.
std::unique_ptr<Truth> make_pair_truth(const Scene& scene, PairsOf what, unsigned threads);

} // namespace boxwood::bench
