#pragma once

#include "trees/executor.h"
#include "trees/layouts/binary.h"
#include "trees/layouts/wide.h"
#include "trees/pairs.h"
#include "trees/work.h"

namespace boxwood {

/// Every unordered pair of overlapping items once, the lower item first, in an order that depends
/// on the tree alone. Two items have one lowest common ancestor, and only there do their branches
/// meet, so there are no duplicates; an item never meets itself.
void self_pairs(const BinaryLayout& tree, const Executor& executor, PairSink& sink);
void self_pairs(const Wide8Layout& tree, const Executor& executor, PairSink& sink);

/// The same on one thread, with the work counted.
Work self_pairs_counted(const BinaryLayout& tree, PairSink& sink);
Work self_pairs_counted(const Wide8Layout& tree, PairSink& sink);

} // namespace boxwood
