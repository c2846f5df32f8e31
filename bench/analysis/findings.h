#pragma once

#include "results/results.h"

#include <string>

namespace boxwood::bench {

/// What a sweep found, for the terminal: per scene, ask and number of threads the cell of ours with
/// the least time to build and query, to query alone, or to update and query, each against the same
/// choice of each library, from `compare`; then the noise floor, and every wrong cell with its
/// witness. Wrong and unchecked cells are not chosen.
std::string findings_text(const results::Results& results);

/// Whether an answer of ours is wrong, or any contender brought its process down.
bool is_promise_broken(const results::Results& results);

} // namespace boxwood::bench
