#pragma once

#include "trees/executor.h"
#include "trees/layouts/binary.h"
#include "trees/layouts/wide.h"
#include "trees/pairs.h"
#include "trees/work.h"

namespace boxwood {

/// Every overlapping pair (item of a, item of b) once, in an order that depends on the trees alone.
/// The trees may be one and the same: then an item also meets itself, and pairs come both ways
/// round.
void tree_pairs(const BinaryLayout& a, const BinaryLayout& b, const Executor& executor,
                PairSink& sink);
void tree_pairs(const Wide8Layout& a, const Wide8Layout& b, const Executor& executor,
                PairSink& sink);

/// The same on one thread, with the work counted.
Work tree_pairs_counted(const BinaryLayout& a, const BinaryLayout& b, PairSink& sink);
Work tree_pairs_counted(const Wide8Layout& a, const Wide8Layout& b, PairSink& sink);

} // namespace boxwood
