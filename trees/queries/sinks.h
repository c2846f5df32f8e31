#pragma once

#include <atomic>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace boxwood {

/// Two items whose boxes overlap. Within one set a < b; between two sets a is of the first.
struct Pair {
    std::uint32_t a, b;
    constexpr auto operator<=>(const Pair&) const = default;
};

/// Where pairs go; the traversal never knows what a pair means.
/// A traversal cuts its work into chunks by the input alone, says how many in `begin`, then hands
/// over each chunk's pairs in batches: in order within a chunk, different chunks perhaps at the
/// same time. Returning false from `take` asks the traversal to stop soon (other batches may still
/// come).
class PairSink {
  public:
    virtual ~PairSink() = default;
    virtual void begin(std::size_t chunks, bool in_order) = 0;
    virtual bool take(std::size_t chunk, std::span<const Pair> pairs) = 0;
    /// No more pairs of this chunk will come. A traversal may leave this out.
    virtual void finish(std::size_t /*chunk*/) {}
    virtual void end() = 0;
};

/// What may be passed as a sink of pairs.
template <class S>
concept PairSinkType = std::derived_from<S, PairSink> && !std::is_abstract_v<S>;

/// Counts pairs.
class CountPairs final : public PairSink {
  public:
    void begin(std::size_t chunks, bool) override { counts_.assign(chunks, {}); }
    bool take(std::size_t chunk, std::span<const Pair> pairs) override {
        counts_[chunk].n += pairs.size();
        return true;
    }
    void end() override {
        total_ = 0;
        for (const Count& c : counts_)
            total_ += c.n;
    }
    std::uint64_t count() const { return total_; }

  private:
    struct alignas(64) Count {
        std::uint64_t n = 0;
    };
    std::vector<Count> counts_;
    std::uint64_t total_ = 0;
};

/// Appends pairs to a vector in chunk order: the same order for any number of threads.
/// The first chunk that is not finished goes straight there, those after it wait in parts that are
/// appended as soon as all before them are: little is left to do at the end.
/// Reused between queries it keeps its memory.
class AppendPairs final : public PairSink {
  public:
    explicit AppendPairs(std::vector<Pair>& out) : out_(out) {}
    void begin(std::size_t chunks, bool in_order) override;
    bool take(std::size_t chunk, std::span<const Pair> pairs) override;
    void finish(std::size_t chunk) override;
    void end() override;

  private:
    struct Part {
        std::vector<Pair> pairs; ///< empty while the chunk goes straight to out_
        bool finished;
    };
    void append(std::size_t chunk);

    std::vector<Pair>& out_;
    bool in_order_ = true; ///< chunks come one after another, and go straight to out_
    std::vector<Part> parts_;
    /// out_ is touched by nobody but the thread that has this chunk, and by whoever moves it on.
    std::atomic<std::size_t> first_ = 0;
    std::mutex moving_;
    std::vector<std::vector<Pair>> spare_; ///< memory of parts no more in use
};

/// Calls `f(pair) -> bool` for each pair until it says false. For one thread, or an `f` that may be
/// called from several.
template <class F> class ForEachPair final : public PairSink {
  public:
    explicit ForEachPair(F f) : f_(std::move(f)) {}
    void begin(std::size_t, bool) override {}
    bool take(std::size_t, std::span<const Pair> pairs) override {
        for (const Pair p : pairs)
            if (!f_(p))
                return false;
        return true;
    }
    void end() override {}

  private:
    F f_;
};

} // namespace boxwood
