#pragma once

#include "bench/tasks/ours.h"
#include "results/results.h"

namespace boxwood::bench {

/// The contender "<builder>[_<setting><value>...].tree" of the ask `tree`: its build makes the
/// canonical tree, and there is no query. Throws std::invalid_argument, with a suggestion, for an
/// unknown word.
ContenderEntry tree_contender(const Choice& choice);

/// Whether the tree that a contender built holds each item in a leaf, and boxes that are exact; in
/// a split tree the parts of each item together as large as its box. It must have a structure.
results::Check check_tree(const Contender& contender, const Scene& scene);

} // namespace boxwood::bench
