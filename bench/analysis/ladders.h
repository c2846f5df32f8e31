#pragma once

#include "results/results.h"

#include <cstddef>
#include <string>

/// What the rows of the kernel table say: what being right costs.
namespace boxwood::bench {

/// A table per kernel family (each rung's errors over all families of cases, its time per call by
/// panel: the sweep's median where there is one), where it errs, and the sentence that a reader
/// takes home. Empty without rows.
std::string ladders_text(const results::Results& results);

/// The rungs of ours that break what they promise, each with its witness, ten at most; a sentence
/// if there are none.
std::string promises_text(const results::Results& results);

/// How many rows of our rungs break their promise.
std::size_t broken_promises(const results::Results& results);

} // namespace boxwood::bench
