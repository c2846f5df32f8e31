#pragma once

#include "bench/config.h"
#include "bench/contender.h"
#include "results/results.h"
#include "trees/function_ref.h"

#include <cstdint>
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

/// Takes a contender that was just built through all frames of the scene: update and query of each
/// are added to its time. `after_frame` is called after each, untimed.
void play(Contender& contender, const Scene& scene, Answers& answers, std::span<FrameTime> times,
          FunctionRef<void(std::size_t frame)> after_frame);

/// A hash of pairs in any order, cheap beside finding them.
std::uint64_t unordered_hash(std::span<const Pair> pairs);

/// One hash of the answers to all frames, whatever the order within a frame.
class FramesHash {
  public:
    void add(std::span<const Pair> pairs) {
        value_ = (value_ ^ unordered_hash(pairs)) * 0x9e3779b97f4a7c15u;
        value_ ^= value_ >> 32;
    }
    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 1;
};

/// The pairs of every frame by an oracle that uses no tree: a sweep along x, or brute force where
/// that is quick.
class MovingTruth {
  public:
    /// `threads` may be used to compute it.
    MovingTruth(const Scene& scene, unsigned threads);

    /// Adds what is wrong with the answers to one frame to the check; the first wrong pair is its
    /// witness. Of frame 0 it sets status and oracle, too.
    void check(std::size_t frame, const Answers& answers, results::Check& check) const;

  private:
    std::vector<std::vector<Pair>> expected_; ///< by frame, ascending
};

} // namespace boxwood::bench
