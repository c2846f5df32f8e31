#pragma once

#include "results/results.h"

namespace boxwood::bench {

/// A lower bound in ns of what any algorithm takes on the machine of a result file for a phase of
/// one of our cells; bench/README.md derives it. NaN where none is known, and for files of several
/// machines.
/// To build, every box is read (24 bytes); to update, those that moved; to query, every pair is
/// written (8 bytes). On a device from end to end, boxes, queries and answers cross through
/// pageable memory besides, by the medians of the measured rates, and each phase is a launch.
double limit_ns(const results::Results& results, const results::Cell& cell, results::Phase phase);

} // namespace boxwood::bench
