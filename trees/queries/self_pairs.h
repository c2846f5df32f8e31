#pragma once

#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/layouts/layouts.h"
#include "trees/queries/sinks.h"

namespace boxwood {

/// Every unordered pair of overlapping items once, the lower item first, in an order that depends
/// on the tree alone. Two items have one lowest common ancestor, and only there do their branches
/// meet, so there are no duplicates; an item never meets itself.
/// `work`, if given, is added to, and the executor must be serial().
#define X(name, L)                                                                                 \
    void self_pairs(const L& tree, const Executor& executor, PairSink& sink, Work* work = nullptr);
BOXWOOD_SEARCHED_TREES(X)
#undef X

/// The same on one thread, with the work counted.
template <class L> Work self_pairs_counted(const L& tree, PairSink& sink) {
    Work work;
    self_pairs(tree, serial(), sink, &work);
    return work;
}

} // namespace boxwood
