#pragma once

#include "bench/truth/truth.h"

namespace boxwood::bench {

/// The rays that are judged: one of each of m equal runs, picked by a hash of the scene's seed;
/// ascending.
std::vector<std::size_t> sampled_rays(const Scene& scene);

/// The truth of rays_all, for the sampled rays, by RayOracle: every triangle that is met for
/// certain is there, none that is missed for certain, and none twice. Those within rounding of an
/// edge or of an end of the ray may be there or not; the answer then is "within_bound".
std::unique_ptr<Truth> make_all_hits_truth(const Scene& scene, unsigned threads);

} // namespace boxwood::bench
