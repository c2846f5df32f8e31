#pragma once

#include "bench/contender.h"
#include "trees/builder.h"

namespace boxwood::bench {

/// One way of ours to do a job, by catalogue words.
struct Choice {
    std::string builder = "binned_sah"; ///< or with a stage: "ploc+reinsertion"
    Settings settings;                  ///< of the builder and the stage
    std::string layout = "wide8";
    std::string kernel = "watertight"; ///< a ray or triangle kernel, where the ask takes one
};

/// The contender "<builder>[_<setting><value>...].<layout>.<traversal>[.<kernel>]" for an ask.
/// Throws std::invalid_argument, with a suggestion, for an unknown word.
ContenderEntry our_contender(const Choice& choice, Ask ask);

} // namespace boxwood::bench
