#pragma once

#include "kernels/primitives/triangle.h"

namespace boxwood::detail {

/// Bounds of the distance of two triangles, 0 <= lo <= hi, and what it is but for rounding.
struct DistanceBounds {
    double lo, hi, distance;
    Vec3<double> point_a, point_b; ///< witnesses of hi
};

/// Bounds, of two that do not touch, in double-double arithmetic: as a rule 1e-12 apart, relative,
/// down to distances of 1e-20 of the size, but any amount where the nearest features are nearly
/// degenerate; for what spans the two at most 1 and at least 1/4 along an axis. Coordinates may be
/// off by 2^-1070. Some microseconds. Bound: derived in refined_bounds.cpp.
DistanceBounds refined_bounds(const Triangle<double>& a, const Triangle<double>& b);

} // namespace boxwood::detail
