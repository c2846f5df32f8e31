#pragma once

#include "kernels/convex/detail/gjk.h"

namespace boxwood::convex::detail {

/// How deep the origin is in the difference of two cores: van den Bergen 2001, "Proximity queries
/// and penetration depth computation on 3D game objects" (expanding polytope), between bounds.
/// simplex, found: where GJK ended, with the origin in it or near, and what it found, which is made
/// better. lo is at least -(about 32u size) if the difference is flat. At most 128 vertices: of
/// round shapes with many directions alike it ends with wider bounds.
void find_depth(const AnyDifference& difference, Simplex simplex, const Goal& goal,
                CoreDistance& found);

} // namespace boxwood::convex::detail
