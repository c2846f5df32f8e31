#pragma once

#include "trees/builder.h"

namespace boxwood {

/// Top-down build by the surface-area heuristic that tries every split: the items are sorted by
/// their centres along each axis once, every prefix of each order is a candidate, counted as items
/// times half area, and the orders are partitioned without sorting again. The cost that others are
/// measured against; slow. O(n log n), depth at most 3 log2(n) + 33. Source: Wald, Boulos and
/// Shirley 2007, "Ray Tracing Deformable Scenes Using Dynamic Bounding Volume Hierarchies".
struct SweepSahBuilder {
    static constexpr std::string_view name = "sweep_sah";
    static constexpr std::string_view summary =
        "top-down, cheapest of all splits along each axis by surface area; the "
        "measure of quality";

    Tree build(Boxes boxes, const Executor& executor) const;
};

} // namespace boxwood
