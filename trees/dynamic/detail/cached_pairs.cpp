#include "trees/dynamic/detail/cached_pairs.h"

#include "trees/dynamic/detail/box_steps.h"
#include "trees/dynamic/detail/survey.h"
#include "trees/dynamic/detail/widen.h"
#include "trees/executors/chunks.h"
#include "trees/queries/regions.h"
#include "trees/queries/self_pairs.h"
#include "trees/traversals/chunk_sink.h"

#include <algorithm>
#include <atomic>
#include <cfloat>
#include <cmath>
#include <limits>
#include <numeric>

namespace boxwood::detail {

/// What the search of a rebuild finds, by chunk, up to a limit.
class CachedPairs::Candidates final : public PairSink {
  public:
    Candidates(std::vector<std::vector<Pair>>& chunks, std::size_t limit)
        : chunks_(chunks), limit_(limit) {}
    void begin(std::size_t chunks, bool) override {
        for (auto& chunk : chunks_)
            chunk.clear();
        chunks_.resize(chunks);
    }
    bool take(std::size_t chunk, std::span<const Pair> pairs) override {
        chunks_[chunk].insert(chunks_[chunk].end(), pairs.begin(), pairs.end());
        return (total_ += pairs.size()) <= limit_;
    }
    void end() override {}
    bool too_many() const { return total_ > limit_; }

  private:
    std::vector<std::vector<Pair>>& chunks_;
    std::atomic<std::size_t> total_ = 0;
    std::size_t limit_;
};

/// Of (number of a fast item, item whose widened box it meets) those that overlap now.
class CachedPairs::AgainstSlow final : public PairSink {
  public:
    AgainstSlow(const CachedPairs& cached, PairSink& sink) : cached_(cached), sink_(sink) {}
    void begin(std::size_t chunks, bool in_order) override { sink_.begin(chunks, in_order); }
    bool take(std::size_t chunk, std::span<const Pair> pairs) override {
        std::vector<Pair> passed;
        for (const Pair pair : pairs)
            if (overlaps(cached_.fast_[pair.a], cached_.boxes_[pair.b])) {
                const std::uint32_t item = cached_.fast_items_[pair.a];
                passed.push_back({std::min(item, pair.b), std::max(item, pair.b)});
            }
        return passed.empty() || sink_.take(chunk, passed);
    }
    void finish(std::size_t chunk) override { sink_.finish(chunk); }
    void end() override { sink_.end(); }

  private:
    const CachedPairs& cached_;
    PairSink& sink_;
};

void CachedPairs::start(Boxes boxes, double expected_step) {
    holds_ = widened_before_ = false;
    side_ = median_side(boxes);
    pace_ = static_cast<float>(std::min(expected_step * side_, double{FLT_MAX} / 8));
    boxes_.resize(boxes.size());
    pairs_ = 5 * n(); // a guess
    steps_.clear();
    out_.clear();
    fresh_.clear();
    fresh_before_ = 0;
    n_parts_ = 0;
}

std::size_t CachedPairs::count_pairs() const {
    std::size_t sum = fast_pairs_.size();
    for (std::size_t p = 0; p < n_parts_; ++p)
        sum += parts_[p].sure().size() + parts_[p].now().size();
    return sum;
}

/// Widened by a margin, for slow items; the other boxes are empty.
bool CachedPairs::rebuild(MovingTree& tree, Boxes boxes, const Executor& executor) {
    const std::size_t size = boxes.size();
    max_slow_step_ = static_cast<float>(std::max(1.25 * double{pace_}, 1e-3 * side_));
    const double reach = 2 * margin_for(double{pace_});
    reach_.per_used = ExpiringPairs::n_buckets / reach;
    used_ = waste_ = 0;
    holds_ = false;

    boxes_.assign(boxes.begin(), boxes.end());
    std::erase_if(
        out_, [&](const Out& out) { return !(out.step > max_slow_step_) || is_absent(out.box); });
    for (const Out& out : out_)
        boxes_[out.item] = Box{};
    for (std::uint32_t i = 0; i < size; ++i)
        if (is_absent(boxes[i]))
            out_.push_back({i, 0, Box{}});
    std::ranges::sort(out_, {}, &Out::item);

    widen_boxes(boxes_, reach / 2, widened_, executor);
    constexpr double max_area_ratio = 1.15;
    if (widened_before_)
        tree.refit(widened_, executor);
    else
        tree.exchange(widened_, executor);
    widened_before_ = true;
    if (tree.area_ratio() > max_area_ratio)
        tree.reorder(widened_, {}, executor);

    Candidates candidates(found_, 64 * size + 65536);
    boxwood::self_pairs(tree.layout(), executor, candidates);
    if (candidates.too_many() || size > max_gap_items)
        return false;
    n_parts_ = std::clamp<std::size_t>(found_.size() / 8, 1, 16);
    if (parts_.size() < n_parts_)
        parts_.resize(n_parts_);
    executor.for_each(n_parts_, [&](std::size_t p) {
        const ChunkRange range(found_.size(), n_parts_, p);
        parts_[p].start(std::span(found_).subspan(range.begin, range.end - range.begin),
                        boxes_.data(), reach_);
    });
    examined_ = 0;
    find_fast(tree, executor);
    pairs_ = static_cast<double>(count_pairs());
    tree.step.pairs_rebuilt = holds_ = true;
    spent_ = rebuild_cost() + (tree.step.rebuilt ? 40 * n() : 0);
    return true;
}

/// All boxes are looked at, sixteen at a time. Returns the largest step of slow items; +inf if they
/// are too few.
float CachedPairs::follow_all(Boxes boxes, const Executor& executor) {
    const std::size_t blocks = (boxes.size() + follow_block - 1) / follow_block;
    steps_.resize(blocks);
    far_.resize(blocks);
    const std::size_t chunks = chunks_for(boxes.size(), executor);
    std::vector<std::size_t> n_far(chunks);
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(blocks, chunks, c);
        n_far[c] = follow_blocks(boxes, boxes_.data(), range.begin, range.end, max_slow_step_,
                                 steps_.data(), far_.data() + range.begin);
    });
    // Nearly everywhere some item went far: those are too many, whichever they are.
    if (std::accumulate(n_far.begin(), n_far.end(), std::size_t{0}) > blocks / 4 * 3 + 16)
        return std::numeric_limits<float>::infinity();
    for (std::size_t c = 0; c < chunks; ++c) {
        const ChunkRange range(blocks, chunks, c);
        for (std::size_t j = range.begin; j < range.begin + n_far[c]; ++j) {
            const std::uint32_t b = far_[j];
            const std::size_t first = b * follow_block;
            steps_[b] = 0;
            for (std::size_t i = first; i < std::min(first + follow_block, boxes.size()); ++i) {
                if (is_absent(boxes_[i]))
                    continue;
                const float step = box_step(boxes[i], boxes_[i]);
                if (step > max_slow_step_) {
                    fresh_.push_back({static_cast<std::uint32_t>(i), step, boxes[i]});
                    continue;
                }
                boxes_[i] = boxes[i];
                steps_[b] = std::max(steps_[b], step);
            }
        }
    }
    return steps_.empty() ? 0 : *std::ranges::max_element(steps_);
}

float CachedPairs::follow_some(Boxes boxes, std::span<const std::uint32_t> moved) {
    steps_.assign((moved.size() + follow_block - 1) / follow_block, 0);
    for (std::size_t j = 0; j < moved.size(); ++j) {
        const std::uint32_t item = moved[j];
        Box& before = boxes_[item];
        if (is_absent(before))
            continue;
        const float step = box_step(boxes[item], before);
        if (step > max_slow_step_) {
            fresh_.push_back({item, step, boxes[item]});
            continue;
        }
        before = boxes[item];
        steps_[j / follow_block] = std::max(steps_[j / follow_block], step);
    }
    return steps_.empty() ? 0 : *std::ranges::max_element(steps_);
}

void CachedPairs::follow_out(Boxes boxes, std::span<const std::uint32_t> moved) {
    const bool look_at_all = is_nearly_all(moved.size(), boxes.size());
    auto next = moved.begin();
    for (Out& out : out_) {
        bool has_moved = true;
        if (!look_at_all) {
            next = std::lower_bound(next, moved.end(), out.item);
            has_moved = next != moved.end() && *next == out.item;
        }
        out.step = has_moved ? box_step(boxes[out.item], out.box) : 0;
        if (has_moved)
            out.box = boxes[out.item];
    }
}

/// Marks the items that went far as fast, or absent.
void CachedPairs::leave_out(const Executor& executor) {
    marks_.resize(boxes_.size());
    for (const Out& out : fresh_) {
        boxes_[out.item] = Box{};
        marks_[out.item] = 1;
    }
    executor.for_each(n_parts_, [&](std::size_t p) { parts_[p].leave_out(marks_.data()); });
    for (const Out& out : fresh_)
        marks_[out.item] = 0;
    spent_ += pairs_ * per_left_out;
}

bool CachedPairs::follow(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                         const Executor& executor) {
    spent_ = 0;
    examined_ = 0;
    searched_ = false;
    tree.step.fast = fast_.size();
    fresh_before_ = fresh_.size();
    fresh_.clear();
    if (moved.empty())
        return true;
    holds_ = false;
    spent_ = static_cast<double>(moved.size()) * per_moved;
    follow_out(boxes, moved);
    const float step = is_nearly_all(moved.size(), boxes.size()) ? follow_all(boxes, executor)
                                                                 : follow_some(boxes, moved);
    const auto middle = static_cast<std::ptrdiff_t>(out_.size());
    out_.insert(out_.end(), fresh_.begin(), fresh_.end());
    std::inplace_merge(out_.begin(), out_.begin() + middle, out_.end(),
                       [](const Out& a, const Out& b) { return a.item < b.item; });
    std::size_t fast = 0;
    for (const Out& out : out_) {
        fast += !is_absent(out.box);
        waste_ += !is_absent(out.box) && out.step <= max_slow_step_ ? per_fast_item : 0;
    }
    if (step > 0)
        used_ = std::nextafter(used_ + 2 * (double{step} * (1 + 0x1p-20) + 2 * double{FLT_MIN}),
                               HUGE_VAL);
    if (fast > boxes_.size() / 16 + 16 || reach_.used_up(used_) || waste_ > rebuild_cost()) {
        forecast_by_frame();
        return false;
    }
    if (!fresh_.empty())
        leave_out(executor);
    if (step > 0) {
        std::vector<std::size_t> examined(n_parts_);
        executor.for_each(n_parts_, [&](std::size_t p) {
            examined[p] = parts_[p].examine(boxes_.data(), used_);
        });
        for (const std::size_t some : examined)
            examined_ += some;
    }
    find_fast(tree, executor);
    holds_ = true;
    pairs_ = static_cast<double>(count_pairs());
    tree.step.examined = examined_;
    spent_ += static_cast<double>(examined_) * per_examined;
    return true;
}

void CachedPairs::find_fast(MovingTree& tree, const Executor& executor) {
    fast_.clear();
    fast_pairs_.clear();
    for (const Out& out : out_)
        if (!is_absent(out.box))
            fast_.push_back(out.box);
    tree.step.fast = fast_.size();
    if (fast_.empty())
        return;
    searched_ = true;
    fast_items_.clear();
    for (const Out& out : out_)
        if (!is_absent(out.box))
            fast_items_.push_back(out.item);
    fast_tree_.take(fast_, coarse_curve_order(fast_, Curve::hilbert, executor), executor);
    AppendPairs sink(fast_pairs_);
    boxwood::self_pairs(fast_tree_, executor, sink);
    for (Pair& pair : fast_pairs_) // ascending, as they are listed
        pair = {fast_items_[pair.a], fast_items_[pair.b]};
    AgainstSlow against(*this, sink);
    boxwood::regions(tree.layout(), Boxes(fast_), executor, against, nullptr);
    spent_ += static_cast<double>(fast_.size()) * per_fast_item;
}

/// Parts in order, then the pairs of the fast items; on the calling thread, as no more than memory
/// is copied.
void CachedPairs::self_pairs(PairSink& sink) const {
    sink.begin(n_parts_ + 1, true);
    std::atomic<bool> stop = false;
    for (std::size_t c = 0; c <= n_parts_; ++c) {
        const ChunkSink to(sink, c, stop, nullptr);
        if (to.stopped())
            break;
        if (c == n_parts_)
            to.take(fast_pairs_);
        else if (to.take(parts_[c].sure()))
            to.take(parts_[c].now());
        sink.finish(c);
    }
    sink.end();
}

Work CachedPairs::self_pairs_counted(const MovingTree& tree, PairSink& sink) const {
    Work work;
    if (searched_) {
        CountPairs ignored;
        work += boxwood::self_pairs_counted(fast_tree_, ignored);
        boxwood::regions(tree.layout(), Boxes(fast_), serial(), ignored, &work);
    }
    work.box_tests += examined_;
    work.answers = count_pairs();
    self_pairs(sink);
    return work;
}

std::size_t CachedPairs::bytes() const {
    std::size_t sum = (boxes_.capacity() + widened_.capacity() + fast_.capacity()) * sizeof(Box);
    sum += (steps_.capacity() + far_.capacity() + fast_items_.capacity()) * sizeof(float) +
           marks_.capacity();
    sum += (out_.capacity() + fresh_.capacity()) * sizeof(Out) + fast_tree_.bytes();
    sum += fast_pairs_.capacity() * sizeof(Pair);
    for (const auto& chunk : found_)
        sum += chunk.capacity() * sizeof(Pair);
    for (const ExpiringPairs& part : parts_)
        sum += part.bytes();
    return sum;
}

std::string CachedPairs::fault() const {
    if (!holds_)
        return "";
    for (std::size_t p = 0; p < n_parts_; ++p)
        if (std::string found = parts_[p].fault(boxes_.data()); !found.empty())
            return found;
    for (const Out& out : out_)
        if (!is_absent(boxes_[out.item]))
            return "item " + std::to_string(out.item) + " is both fast and cached";
    return "";
}

} // namespace boxwood::detail
