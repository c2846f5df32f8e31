#pragma once

#include "kernels/primitives/triangle.h"

namespace boxwood::detail {

/// Bounds of the distance of two triangles, 0 <= lo <= hi, and what it is but for rounding.
struct DistanceBounds {
    double lo, hi, distance;
    Vec3<double> point_a, point_b; ///< witnesses of hi
};

/// Nearly tight bounds, of two that do not touch, in double-double arithmetic: relative width about
/// 1e-12 or less down to distances of 1e-20 of the size; for what spans the two at most 1 and at
/// least 1/4 along an axis. Coordinates may be off by 2^-1070. Some microseconds. Bound: derived in
/// refined_bounds.cpp.
DistanceBounds refined_bounds(const Triangle<double>& a, const Triangle<double>& b);

/// A positive lower bound of the distance of any two triangles that do not touch, of which the
/// coordinates are multiples of 2^grid and differ by less than 2^size; 0 if it is below 2^-1074.
double min_separation(int grid, int size);

/// The greatest `grid` for the two: their coordinates are finite, and not all 0.
int coordinate_grid(const Triangle<double>& a, const Triangle<double>& b);

} // namespace boxwood::detail
