#pragma once

#include "bench/truth/truth.h"
#include "trees/layout.h"

namespace boxwood::bench {

/// The right nearest hits, or whether there is a hit, of a seeded sample of the scene's rays, by
/// brute force in double (RayOracle). An answer within rounding of an edge is "within_bound".
std::unique_ptr<Truth> make_hit_truth(const Scene& scene, RayQuery query, unsigned threads);

} // namespace boxwood::bench
