#pragma once

#include "bench/truth/pairs_digest.h"
#include "results/results.h"
#include "scenes/moving/frames.h"

#include <functional>
#include <span>
#include <vector>

namespace boxwood::bench {

/// The pairs of every frame by an oracle that uses no tree (`ColumnSweep`), found when the frame is
/// first seen. It holds number and hash of each frame alone; which pairs they are is found again
/// where an answer differs.
class MovingTruth {
  public:
    /// `threads` may be used. is_left_out: pairs that are no answers, given lower body first.
    explicit MovingTruth(unsigned threads, std::function<bool(Pair)> is_left_out = {});

    /// Adds what is wrong with the answers to frame `index` (from 0, in order at first) to the
    /// check, whose witness is the first wrong pair. False if something is.
    bool check(std::size_t index, const Frame& frame, std::span<const Pair> answers,
               results::Check& check);

  private:
    unsigned threads_;
    std::function<bool(Pair)> is_left_out_;
    std::vector<PairsDigest> expected_; ///< by frame
};

} // namespace boxwood::bench
