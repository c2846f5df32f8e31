#pragma once

#include "kernels/oracle/rational.h"

#include <tuple>

namespace boxwood::oracle {

/// The rational kernels, to be listed and run beside the kernels of the same family.
using RationalTriangleKernels = std::tuple<RationalTriangles>;
using RationalTriangleDistanceKernels = std::tuple<RationalTriangleDistance>;
using RationalSegmentDistanceKernels = std::tuple<RationalSegmentDistance>;
using RationalPointTriangleKernels = std::tuple<RationalPointTriangle>;
using RationalPointSegmentKernels = std::tuple<RationalPointSegment>;
using RationalRayKernels = std::tuple<RationalRays>;

} // namespace boxwood::oracle
