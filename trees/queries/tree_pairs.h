#pragma once

#include "trees/executor.h"
#include "trees/layouts/binary.h"
#include "trees/layouts/packed.h"
#include "trees/layouts/wide.h"
#include "trees/queries/pairs.h"
#include "trees/inspect/work.h"

namespace boxwood {

/// Every overlapping pair (item of a, item of b) once, in an order that depends on the trees alone.
/// The trees may be one and the same: then an item also meets itself, and pairs come both ways
/// round.
template <class Real>
void tree_pairs(const BinaryLayoutOf<Real>& a, const BinaryLayoutOf<Real>& b,
                const Executor& executor, PairSink& sink);
template <WideTree L>
void tree_pairs(const L& a, const L& b, const Executor& executor, PairSink& sink);
void tree_pairs(const PackedLayout& a, const PackedLayout& b, const Executor& executor,
                PairSink& sink);

/// The same on one thread, with the work counted.
template <class Real>
Work tree_pairs_counted(const BinaryLayoutOf<Real>& a, const BinaryLayoutOf<Real>& b,
                        PairSink& sink);
template <WideTree L> Work tree_pairs_counted(const L& a, const L& b, PairSink& sink);
Work tree_pairs_counted(const PackedLayout& a, const PackedLayout& b, PairSink& sink);

} // namespace boxwood
