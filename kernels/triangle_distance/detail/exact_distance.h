#pragma once

#include "kernels/arithmetic/detail/long_integer.h"
#include "kernels/primitives/triangle.h"

namespace boxwood::detail {

/// The distance of two triangles of any finite doubles within 2^-50, relative; 0 if they touch.
/// Derived in greatest_gap.h. Tens of microseconds if the coordinates are of like size,
/// milliseconds if they span all exponents.
Scaled exact_distance(const Triangle<double>& a, const Triangle<double>& b);

} // namespace boxwood::detail
