#pragma once

#include "trees/queries/sinks.h"

#include <atomic>
#include <cstdint>
#include <span>

namespace boxwood {

/// Counts pairs until there are more than `limit`, and then asks the traversal to stop.
class CountPairsUpTo final : public PairSink {
  public:
    explicit CountPairsUpTo(std::uint64_t limit) : limit_(limit) {}

    void begin(std::size_t, bool) override { count_ = 0; }
    bool take(std::size_t, std::span<const Pair> pairs) override {
        return (count_ += pairs.size()) <= limit_;
    }
    void end() override {}

    /// All pairs, if they are no more than the limit; else some number above it. May be read while
    /// the traversal is under way.
    std::uint64_t count() const { return count_; }

  private:
    std::uint64_t limit_;
    std::atomic<std::uint64_t> count_ = 0;
};

} // namespace boxwood
