#pragma once

#include "results/results.h"

namespace boxwood::bench {

/// The least time in ns that the machine of a result file could take for a phase of one of our
/// cells, by its own memory bandwidth and clock: what must be moved (a box is 24 bytes, the two
/// nodes of an item 64, a pair 8; to update, of the items that moved) and, of pairs, what must be
/// done (0.31 cycles for a box test sixteen at a time, a cycle for a pair). No such bound is known
/// of other work: NaN. Of a sum of two phases the sum.
/// Of a cell on a device by what it counted: the bytes at the rate of a copy there, the launches,
/// of a query 8 cycles of a lane for each box test that the same contender counted on processors;
/// and from end to end the boxes up and the pairs down through pageable memory. Rates are medians
/// over the rounds.
double limit_ns(const results::Results& results, const results::Cell& cell, results::Phase phase);

} // namespace boxwood::bench
