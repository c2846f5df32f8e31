#pragma once

#include "bench/tasks/contender.h"
#include "trees/builder.h"

namespace boxwood::bench {

/// One way of ours to do a job, by registry words.
struct Choice {
    std::string builder = "binned_sah"; ///< or with an optimizer: "ploc+reinsertion"
    Settings settings;                  ///< of the builder and the stage
    std::string layout = "wide8";
    std::string kernel = "watertight"; ///< a ray or triangle kernel, where the ask takes one
    std::string ray_order = "given";   ///< or "sorted", "single"; of rays_closest and rays_any
};

/// The contender "<builder>[_<setting><value>...].<layout>.<traversal>[.<kernel>]" for an ask.
/// Throws std::invalid_argument, with a suggestion, for an unknown word, and for the asks of update
/// policies (moving_pairs.h) and kernels (rungs/rungs.h).
ContenderEntry our_contender(const Choice& choice, Ask ask);

/// "binned_sah_bins16": words [a-z0-9_], so 1.5 is written 1_5, a minus m and a plus _.
std::string word_with_settings(std::string word, const Settings& settings);
/// As one JSON object.
std::string settings_json(const Settings& settings);

/// Appends pairs to one vector after another; the sink keeps its memory between queries.
class PairsInto {
  public:
    /// The cleared vector's sink.
    AppendPairs& to(std::vector<Pair>& pairs) {
        pairs.clear();
        if (target_ != &pairs) {
            sink_.emplace(pairs);
            target_ = &pairs;
        }
        return *sink_;
    }

  private:
    std::optional<AppendPairs> sink_;
    std::vector<Pair>* target_ = nullptr;
};

} // namespace boxwood::bench
