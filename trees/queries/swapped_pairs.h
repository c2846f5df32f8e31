#pragma once

#include "trees/queries/pairs.h"

#include <algorithm>
#include <array>

namespace boxwood {

/// Hands on to another sink each pair the other way round, in the same order and chunks.
class SwappedPairs final : public PairSink {
  public:
    explicit SwappedPairs(PairSink& sink) : sink_(sink) {}

    void begin(std::size_t chunks, bool in_order) override { sink_.begin(chunks, in_order); }
    bool take(std::size_t chunk, std::span<const Pair> pairs) override {
        std::array<Pair, 256> swapped; // 2 KiB of stack
        for (std::size_t done = 0; done < pairs.size();) {
            const std::size_t n = std::min(swapped.size(), pairs.size() - done);
            for (std::size_t i = 0; i < n; ++i)
                swapped[i] = {pairs[done + i].b, pairs[done + i].a};
            if (!sink_.take(chunk, {swapped.data(), n}))
                return false;
            done += n;
        }
        return true;
    }
    void finish(std::size_t chunk) override { sink_.finish(chunk); }
    void end() override { sink_.end(); }

  private:
    PairSink& sink_;
};

} // namespace boxwood
