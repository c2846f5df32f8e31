#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/sphere.h"
#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/layouts/layouts.h"
#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <span>

namespace boxwood {

/// For each box or ball every item whose box shares a point with it, as pairs (region, item) by
/// region and then by item. A region with a NaN, or min > max, shares nothing.
/// `work`, if given, is added to, and the executor must be serial().
#define X(name, L)                                                                                 \
    void regions(const L& layout, std::span<const Box> regions, const Executor& executor,          \
                 PairSink& sink, Work* work = nullptr);                                            \
    void regions(const L& layout, std::span<const Sphere<float>> regions,                          \
                 const Executor& executor, PairSink& sink, Work* work = nullptr);
BOXWOOD_SEARCHED_TREES(X)
#undef X

} // namespace boxwood
