#pragma once

#include "bench/truth/truth.h"

namespace boxwood::bench {

/// Nearer than this two meshes in motion have met: 1e-5 of the diagonal of the mesh's box, as FCL
/// stops where 1e-5 of the motion is left.
double meeting_tolerance(const TriangleMesh& mesh);

/// When the copy first touches the mesh, on its way from each pose to the next. Each motion is
/// sampled so closely that nothing can touch between two samples, from the exact least distances
/// there and the greatest speed of a vertex, until the two are nearer than half the tolerance. Up
/// to there any t_free is right; beyond, a t_free is wrong before which one of 40 samples touches,
/// and so is "never". At a t_hit they must be nearer than 8 tolerances. Nothing of trees/world/ is
/// in it.
std::unique_ptr<Truth> make_first_meeting_truth(const Scene& scene, unsigned threads);

} // namespace boxwood::bench
