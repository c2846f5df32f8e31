#pragma once

#include "trees/queries/sinks.h"

#include <algorithm>
#include <array>
#include <utility>

namespace boxwood {

/// Hands on pairs to another sink, in the same order and chunks.
class PairFilter : public PairSink {
  public:
    void begin(std::size_t chunks, bool in_order) override { sink_.begin(chunks, in_order); }
    void finish(std::size_t chunk) override { sink_.finish(chunk); }
    void end() override { sink_.end(); }

  protected:
    explicit PairFilter(PairSink& sink) : sink_(sink) {}

    PairSink& sink_;
    /// A batch of any length passes through in pieces: 2 KiB of stack.
    using Piece = std::array<Pair, 256>;
};

/// Those pairs for which `keep(pair)` is true. `keep` may be called from several threads at the
/// same time.
template <class Keep> class FilteredPairs final : public PairFilter {
  public:
    FilteredPairs(Keep keep, PairSink& sink) : PairFilter(sink), keep_(std::move(keep)) {}

    bool take(std::size_t chunk, std::span<const Pair> pairs) override {
        Piece kept;
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

  private:
    Keep keep_;
};

/// Each pair the other way round.
class SwappedPairs final : public PairFilter {
  public:
    explicit SwappedPairs(PairSink& sink) : PairFilter(sink) {}

    bool take(std::size_t chunk, std::span<const Pair> pairs) override {
        Piece swapped;
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
};

} // namespace boxwood
