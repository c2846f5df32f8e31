#pragma once

#include "bench/io/progress.h"
#include "trees/queries/filters.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace boxwood::bench {

/// Hands pairs on to another sink, says now and then how far the traversal is, by the work of
/// its chunks, and asks it to stop at Ctrl-C (a CtrlC must live).
class WatchedPairs final : public PairFilter {
  public:
    using Clock = std::chrono::steady_clock;

    /// note(): how much was found, for the end of the line. period: of lines; 0.2 s for a bar, 10 s
    /// for lines that stay, if negative.
    WatchedPairs(PairSink& sink, Progress& progress, std::string stage,
                 std::function<std::string()> note, Clock::duration period = Clock::duration(-1));

    void begin(std::size_t chunks, bool in_order) override;
    bool take(std::size_t chunk, std::span<const Pair> pairs) override;
    void finish(std::size_t chunk) override;

    /// An estimate of the share of the work that is done. A chunk's work is the pairs that it
    /// finds, and `base` for its traversal; one that is not finished is expected to be like those
    /// seen so far, each counted as often as its work: so few heavy chunks behind many light ones
    /// count.
    double fraction() const;

  private:
    void look();

    Progress& progress_;
    std::string stage_;
    std::function<std::string()> note_;
    Clock::duration period_;
    Clock::time_point start_;
    struct Chunk {
        std::atomic<std::uint64_t> work = 0;
        std::atomic<bool> is_finished = false;
    };
    static constexpr std::uint64_t base = 1000;

    std::vector<Chunk> chunks_;
    std::atomic<Clock::rep> next_ = 0; ///< when to say something, since the start
    std::mutex saying_;
};

} // namespace boxwood::bench
