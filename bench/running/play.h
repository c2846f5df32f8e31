#pragma once

#include "bench/tasks/task.h"
#include "results/results.h"
#include "scenes/moving/frames.h"
#include "trees/function_ref.h"

#include <cstdint>
#include <span>

namespace boxwood::bench {

/// What one frame took, summed over passes: elapsed time, and that of the processor.
struct FrameTime {
    double update_ns = 0, query_ns = 0, update_cpu_ns = 0, query_cpu_ns = 0;
    std::uint64_t answers = 0; ///< of the last pass
};

/// What the query of one frame does and what its structure is like, apart from any clock; missing
/// where the contender cannot count.
struct FrameCount {
    std::uint64_t box_tests = results::no_count;
    double sah = results::missing; ///< Updater::sah
};
/// Untimed, of the newest frame. A contender that counts answers once more.
FrameCount count_frame(Contender& contender, Answers& answers);

/// Takes a contender that was just built through all frames, as many as there are times: update and
/// query of each are added to its time. frames: null if the contender makes its own.
/// `after_frame` is called after each, from 0, untimed, as are frames that must be made first.
void play(Contender& contender, Frames* frames, Answers& answers, std::span<FrameTime> times,
          FunctionRef<void(std::size_t index, const Frame& frame)> after_frame);

/// One hash of the answers to all frames.
class FramesHash {
  public:
    void add(std::uint64_t hash) {
        value_ = (value_ ^ hash) * 0x9e3779b97f4a7c15u;
        value_ ^= value_ >> 32;
    }
    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 1;
};

} // namespace boxwood::bench
