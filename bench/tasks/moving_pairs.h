#pragma once

#include "bench/plan/config.h"
#include "bench/tasks/contender.h"
#include "bench/truth/truth.h"
#include "results/results.h"
#include "scenes/moving/frames.h"
#include "trees/function_ref.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace boxwood::bench {

/// The contender "<policy>[_<setting><value>...].packed.self_pairs" for Ask::moving_pairs.
/// Throws std::invalid_argument, with a suggestion, for an unknown word.
ContenderEntry moving_contender(const BuilderChoice& policy);

/// What one frame took, summed over passes: elapsed time, and that of the processor.
struct FrameTime {
    double update_ns = 0, query_ns = 0, update_cpu_ns = 0, query_cpu_ns = 0;
    std::uint64_t pairs = 0; ///< of the last pass
};

/// Takes the contender through one frame: update and query are added to its time.
void play_frame(Contender& contender, const Frame& frame, Answers& answers, FrameTime& time);

/// What the query of one frame does and what its structure is like, apart from any clock; missing
/// where the contender cannot tell.
struct FrameCount {
    std::uint64_t box_tests = results::no_count;
    double sah = results::missing; ///< Updater::sah
};
/// Untimed, of the newest frame. A contender that counts answers once more.
FrameCount count_frame(Contender& contender, Answers& answers);

/// Takes a contender that was just built through all frames: update and query of each are added to
/// its time. `after_frame` is called after each, from 0, untimed. Frames that must be made first
/// are made untimed.
void play(Contender& contender, Frames& frames, Answers& answers, std::span<FrameTime> times,
          FunctionRef<void(std::size_t index, const Frame& frame)> after_frame);

/// One hash of the answers to all frames, whatever the order within a frame.
class FramesHash {
  public:
    void add(std::span<const Pair> pairs) { add(digest_of(pairs).hash); }
    void add(std::uint64_t hash) {
        value_ = (value_ ^ hash) * 0x9e3779b97f4a7c15u;
        value_ ^= value_ >> 32;
    }
    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 1;
};

/// The pairs of every frame by an oracle that uses no tree (`ColumnSweep`). Of each frame it holds
/// number and hash alone; which pairs they are is found again where an answer differs.
class MovingTruth {
  public:
    /// `threads` may be used. The frames then stand at the start. is_left_out: pairs that are no
    /// answers, given lower body first.
    MovingTruth(Frames& frames, unsigned threads, std::function<bool(Pair)> is_left_out = {});

    /// Adds what is wrong with the answers to frame `index` (from 0) to the check; the first wrong
    /// pair is its witness. Of frame 0 it sets status and oracle, too.
    void check(std::size_t index, const Frame& frame, const Answers& answers,
               results::Check& check) const;

  private:
    unsigned threads_;
    std::function<bool(Pair)> is_left_out_;
    std::vector<PairsDigest> expected_; ///< by frame
};

} // namespace boxwood::bench
