#pragma once

#include "kernels/primitives/vec3.h"
#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/layouts/layouts.h"
#include "trees/queries/sinks.h"

#include <span>

namespace boxwood {

/// For each point every item whose box contains it, as pairs (point, item) by point and then by
/// item. A point that is not finite is in no box.
/// `work`, if given, is added to, and the executor must be serial().
#define X(name, L)                                                                                 \
    void points(const L& layout, std::span<const Vec3<float>> points, const Executor& executor,    \
                PairSink& sink, Work* work = nullptr);
BOXWOOD_SEARCHED_TREES(X)
#undef X

} // namespace boxwood
