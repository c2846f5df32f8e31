#include "bench/commands/watched_pairs.h"

#include "bench/running/interrupt.h"

#include <fmt/format.h>

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
    chunks_ = chunks;
    finished_ = 0;
    start_ = Clock::now();
    next_ = period_.count();
    PairFilter::begin(chunks, in_order);
}

bool WatchedPairs::take(std::size_t chunk, std::span<const Pair> pairs) {
    look();
    return !CtrlC::pressed() && sink_.take(chunk, pairs);
}

void WatchedPairs::finish(std::size_t chunk) {
    ++finished_;
    look();
    PairFilter::finish(chunk);
}

double WatchedPairs::fraction() const {
    return chunks_ ? static_cast<double>(finished_) / static_cast<double>(chunks_) : 0;
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
