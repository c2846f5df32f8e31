#pragma once

#include "trees/queries/pairs.h"

#include <array>
#include <utility>

namespace boxwood {

/// Hands on to another sink the pairs for which `keep(pair)` is true, in the same order and chunks.
/// `keep` may be called from several threads at the same time.
template <class Keep> class FilteredPairs final : public PairSink {
  public:
    FilteredPairs(Keep keep, PairSink& sink) : keep_(std::move(keep)), sink_(sink) {}

    void begin(std::size_t chunks, bool in_order) override { sink_.begin(chunks, in_order); }

    bool take(std::size_t chunk, std::span<const Pair> pairs) override {
        std::array<Pair, 256>
            kept; // 2 KiB of stack: a batch of any length passes through in pieces
        std::size_t n = 0;
        for (const Pair p : pairs) {
            if (!keep_(p))
                continue;
            kept[n++] = p;
            if (n == kept.size()) {
                if (!sink_.take(chunk, kept))
                    return false;
                n = 0;
            }
        }
        return n == 0 || sink_.take(chunk, {kept.data(), n});
    }

    void finish(std::size_t chunk) override { sink_.finish(chunk); }
    void end() override { sink_.end(); }

  private:
    Keep keep_;
    PairSink& sink_;
};

} // namespace boxwood
