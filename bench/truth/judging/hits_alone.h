#pragma once

#include "scenes/hard_cases/hard_cases.h"

#include <string>
#include <vector>

namespace boxwood::bench {

/// What the kernel says of each triangle alone, without a tree, by t and then by triangle.
std::vector<RayHit> hits_alone(const std::string& kernel, const RayCase& c,
                               const std::vector<Triangle<float>>& triangles);

} // namespace boxwood::bench
