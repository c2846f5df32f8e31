#pragma once

#include "bench/analysis/statistics.h"
#include "results/results.h"

#include <string>
#include <vector>

namespace boxwood::bench {

/// A policy, ours or a peer's way, that follows the boxes of a moving scene.
struct Policy {
    std::string name; ///< "cached", "FCL: dynamic_aabb_tree.moved"
    bool is_peer = false;
    MedianInterval frame;    ///< ns for the update and the pairs of a frame
    PairedRatio over_best;   ///< its time over that of the best of ours
    bool is_as_good = false; ///< not told apart from the best beyond noise
};

/// All right ones by rising time, the best of ours with is_as_good. Of a result with one scene.
/// Throws BadInput if none of ours was timed and right.
struct PolicyAdvice {
    std::string scene;
    std::vector<Policy> policies;
    std::size_t best = 0;
};
PolicyAdvice advise_of_policies(const results::Results& results);

std::string policies_text(const PolicyAdvice& advice);
std::string policies_json(const PolicyAdvice& advice);

} // namespace boxwood::bench
