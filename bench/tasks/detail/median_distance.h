#pragma once

#include "scenes/scene.h"

namespace boxwood::bench {

/// A distance within which half of a scene's copies are: half-way between the two middle ones of
/// their least distances, so that none is near to it, or, where half of them touch, 1e-3 of the
/// diagonal of the mesh's box. By our own tree, whose rounding it forgives; what each pose's answer
/// must be the truth finds without it. 0 without poses.
double median_distance(const Scene& scene);

} // namespace boxwood::bench
