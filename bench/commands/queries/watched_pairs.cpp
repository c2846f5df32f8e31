#include "bench/commands/queries/watched_pairs.h"

#include "bench/running/interrupt.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {

WatchedPairs::WatchedPairs(PairSink& sink, Progress& progress, std::string stage,
                           std::function<std::string()> note, Clock::duration period)
    : PairFilter(sink), progress_(progress), stage_(std::move(stage)), note_(std::move(note)),
      period_(period) {
    if (period < Clock::duration::zero())
        period_ =
            progress.is_terminal() ? std::chrono::milliseconds(200) : std::chrono::seconds(10);
}

void WatchedPairs::begin(std::size_t chunks, bool in_order) {
    chunks_ = std::vector<Chunk>(chunks);
    start_ = Clock::now();
    next_ = period_.count();
    PairFilter::begin(chunks, in_order);
}

bool WatchedPairs::take(std::size_t chunk, std::span<const Pair> pairs) {
    look();
    if (CtrlC::pressed())
        return false;
    chunks_[chunk].work.fetch_add(pairs.size(), std::memory_order_relaxed);
    return sink_.take(chunk, pairs);
}

void WatchedPairs::finish(std::size_t chunk) {
    chunks_[chunk].work.fetch_add(base, std::memory_order_relaxed);
    chunks_[chunk].is_finished = true;
    look();
    PairFilter::finish(chunk);
}

double WatchedPairs::fraction() const {
    double done = 0, squares = 0, left = 0;
    for (const Chunk& chunk : chunks_) {
        const auto work = static_cast<double>(chunk.work.load(std::memory_order_relaxed));
        done += work;
        squares += work * work;
    }
    if (done == 0)
        return 0;
    const double expected = squares / done;
    for (const Chunk& chunk : chunks_)
        if (!chunk.is_finished)
            left += std::max(
                0.0, expected - static_cast<double>(chunk.work.load(std::memory_order_relaxed)));
    return done / (done + left);
}

void WatchedPairs::look() {
    const Clock::duration past = Clock::now() - start_;
    Clock::rep due = next_;
    if (past.count() < due || !next_.compare_exchange_strong(due, (past + period_).count()))
        return;
    const std::lock_guard lock(saying_);
    const double share = fraction(), past_s = std::chrono::duration<double>(past).count();
    const double left_s = share > 0 ? past_s * (1 - share) / share : -1;
    if (progress_.is_terminal())
        return progress_.show({stage_, share, left_s, note_()});
    progress_.say(fmt::format("{}: {:.0f} %, {}{}", stage_, 100 * share, note_(),
                              left_s < 0 ? "" : fmt::format(", {} left", duration_text(left_s))));
}

} // namespace boxwood::bench
