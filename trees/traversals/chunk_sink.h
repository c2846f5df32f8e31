#pragma once

#include "trees/inspect/work.h"
#include "trees/queries/sinks.h"

#include <atomic>

namespace boxwood::detail {

/// The way of one chunk's answers to the sink, and the word to all other chunks that it has had
/// enough.
class ChunkSink {
  public:
    ChunkSink(PairSink& sink, std::size_t chunk, std::atomic<bool>& stop, Work* work)
        : sink_(sink), chunk_(chunk), stop_(stop), work_(work) {}

    /// False once the sink has had enough. `work`, if given, counts the answers.
    bool take(std::span<const Pair> pairs) const {
        if (pairs.empty())
            return true;
        if (work_)
            work_->answers += pairs.size();
        const bool more = !stopped() && sink_.take(chunk_, pairs);
        if (!more)
            stop_.store(true, std::memory_order_relaxed);
        return more;
    }
    bool stopped() const { return stop_.load(std::memory_order_relaxed); }

  private:
    PairSink& sink_;
    std::size_t chunk_;
    std::atomic<bool>& stop_;
    Work* work_;
};

} // namespace boxwood::detail
