#pragma once

#include "kernels/convex/detail/gjk.h"

namespace boxwood::convex::detail {

/// How deep the origin is in the difference of two cores: van den Bergen 2001, "Proximity queries
/// and penetration depth computation on 3D game objects" (expanding polytope), between bounds.
/// start: where GJK ended, with the origin in it or near. lo is at least -(about 32u size) if the
/// difference is flat. At most 128 vertices: of round shapes with many directions alike it ends
/// with wider bounds.
CoreDistance depth_of_origin(const AnyDifference& difference, const Simplex& start,
                             const Goal& goal);

} // namespace boxwood::convex::detail
