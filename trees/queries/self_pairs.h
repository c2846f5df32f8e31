#pragma once

#include "trees/executor.h"
#include "trees/layouts/binary.h"
#include "trees/layouts/packed.h"
#include "trees/layouts/wide.h"
#include "trees/queries/pairs.h"
#include "trees/inspect/work.h"

namespace boxwood {

/// Every unordered pair of overlapping items once, the lower item first, in an order that depends
/// on the tree alone. Two items have one lowest common ancestor, and only there do their branches
/// meet, so there are no duplicates; an item never meets itself.
template <class Real>
void self_pairs(const BinaryLayoutOf<Real>& tree, const Executor& executor, PairSink& sink);
template <WideTree L> void self_pairs(const L& tree, const Executor& executor, PairSink& sink);
void self_pairs(const PackedLayout& tree, const Executor& executor, PairSink& sink);

/// The same on one thread, with the work counted.
template <class Real> Work self_pairs_counted(const BinaryLayoutOf<Real>& tree, PairSink& sink);
template <WideTree L> Work self_pairs_counted(const L& tree, PairSink& sink);
Work self_pairs_counted(const PackedLayout& tree, PairSink& sink);

} // namespace boxwood
