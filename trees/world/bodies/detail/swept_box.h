#pragma once

#include "kernels/convex/motion.h"
#include "trees/world/bodies/shape_pairs.h"

namespace boxwood::detail {

/// The motion as kernels/convex/ has it.
convex::Motion convex_motion(const MovingShape& of);

/// A box around a bounded shape, its radius and its margin at every t from 0 to 1, and what is
/// nearer than first contacts can tell apart.
Aabb<double> swept_box(const MovingShape& of);

} // namespace boxwood::detail
