#pragma once

#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/layouts/layouts.h"
#include "trees/queries/sinks.h"

namespace boxwood {

/// Every overlapping pair (item of a, item of b) once, in an order that depends on the trees alone.
/// The trees may be one and the same: then an item also meets itself, and pairs come both ways
/// round. `work`, if given, is added to, and the executor must be serial().
#define X(name, L)                                                                                 \
    void tree_pairs(const L& a, const L& b, const Executor& executor, PairSink& sink,              \
                    Work* work = nullptr);
BOXWOOD_SEARCHED_TREES(X)
#undef X

/// The same on one thread, with the work counted.
template <class L> Work tree_pairs_counted(const L& a, const L& b, PairSink& sink) {
    Work work;
    tree_pairs(a, b, serial(), sink, &work);
    return work;
}

} // namespace boxwood
