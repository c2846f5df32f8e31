#pragma once

#include "trees/layout.h"
#include "trees/queries/answers.h"

#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace boxwood {

/// A function of pairs or items: one that returns bool ends the query by false.
template <class F, class Found>
concept Visitor = std::invocable<F&, Found> && !std::derived_from<std::remove_cvref_t<F>, PairSink>;

/// What Bvh and DynamicBvh answer about boxes: closed, so that one shared point counts. Each query
/// returns its answers, or hands them to a sink or a function, or counts them; queries of many run
/// on the threads of the options. The order of what is returned is the same for any number of
/// threads. Functions are called from those threads, several at a time; but one that returns bool
/// from the caller's alone, until it says false.
///
/// Threads: any number of them may call const members of one tree at the same time. Who changes it
/// (update, insert, move ...) is alone with it meanwhile.
class BoxQueries {
  public:
    /// Every two items that overlap, once, the lower item first.
    std::vector<Pair> self_pairs() const;
    void self_pairs(PairSink& sink) const { layout_->self_pairs(*executor_, sink); }
    template <Visitor<Pair> F> void self_pairs(F&& visit) const {
        with_pairs(visit, [&](const Executor& executor, PairSink& sink) {
            layout_->self_pairs(executor, sink);
        });
    }
    std::uint64_t self_pair_count() const;

    /// Every overlapping (item here, item of `other`) once. Trees of different layouts throw
    /// std::invalid_argument.
    std::vector<Pair> pairs(const BoxQueries& other) const;
    void pairs(const BoxQueries& other, PairSink& sink) const {
        layout_->tree_pairs(*other.layout_, *executor_, sink);
    }
    template <Visitor<Pair> F> void pairs(const BoxQueries& other, F&& visit) const {
        with_pairs(visit, [&](const Executor& executor, PairSink& sink) {
            layout_->tree_pairs(*other.layout_, executor, sink);
        });
    }
    std::uint64_t pair_count(const BoxQueries& other) const;

    /// The items that share a point with a box or ball, ascending. A region with a NaN, or min >
    /// max, shares none.
    std::vector<std::uint32_t> overlapping(const Box& box) const;
    std::vector<std::uint32_t> overlapping(const Sphere<float>& ball) const;
    /// The items whose boxes contain a point, ascending; none of a point that is not finite.
    std::vector<std::uint32_t> containing(Vec3<float> point) const;
    template <Visitor<std::uint32_t> F> void overlapping(const Box& box, F&& visit) const {
        with_items(visit, [&](PairSink& sink) { layout_->regions({&box, 1}, serial(), sink); });
    }
    template <Visitor<std::uint32_t> F>
    void overlapping(const Sphere<float>& ball, F&& visit) const {
        with_items(visit, [&](PairSink& sink) { layout_->regions({&ball, 1}, serial(), sink); });
    }
    template <Visitor<std::uint32_t> F> void containing(Vec3<float> point, F&& visit) const {
        with_items(visit, [&](PairSink& sink) { layout_->points({&point, 1}, serial(), sink); });
    }

    /// The same of many at a time. Into a sink: as pairs (query, item).
    AnswersOf<std::uint32_t> overlapping(Boxes boxes) const;
    AnswersOf<std::uint32_t> overlapping(std::span<const Sphere<float>> balls) const;
    AnswersOf<std::uint32_t> containing(std::span<const Vec3<float>> points) const;
    void overlapping(Boxes boxes, PairSink& sink) const {
        layout_->regions(boxes, *executor_, sink);
    }
    void overlapping(std::span<const Sphere<float>> balls, PairSink& sink) const {
        layout_->regions(balls, *executor_, sink);
    }
    void containing(std::span<const Vec3<float>> points, PairSink& sink) const {
        layout_->points(points, *executor_, sink);
    }

    /// The k items nearest to a point, by distance and then by item; fewer if there are fewer, none
    /// of a point that is not finite. Throws std::length_error for a k beyond memory.
    std::vector<Neighbour> nearest(Vec3<float> point, std::size_t k = 1) const;
    /// Of many: k to a point, filled up with no item (Neighbour::none). Throws std::length_error
    /// for more than memory can hold.
    std::vector<Neighbour> nearest(std::span<const Vec3<float>> points, std::size_t k = 1) const;

    /// The part beneath, with all that it answers.
    const AnyLayout& layout() const { return *layout_; }
    const Executor& executor() const { return *executor_; }

  protected:
    BoxQueries(std::unique_ptr<AnyLayout> layout, std::shared_ptr<const Executor> executor)
        : layout_(std::move(layout)), executor_(std::move(executor)) {}
    BoxQueries(BoxQueries&&) noexcept = default;
    BoxQueries& operator=(BoxQueries&&) noexcept = default;
    ~BoxQueries() = default;

    std::unique_ptr<AnyLayout> layout_;
    std::shared_ptr<const Executor> executor_;

  private:
    template <class F, class Found>
    static constexpr bool may_end = std::same_as<std::invoke_result_t<F&, Found>, bool>;
    template <class F, class Found> static bool goes_on(F& visit, Found found) {
        if constexpr (may_end<F, Found>) {
            return visit(found);
        } else {
            visit(found);
            return true;
        }
    }
    template <class F, class Query> void with_pairs(F& visit, const Query& query) const {
        ForEachPair sink([&](Pair pair) { return goes_on(visit, pair); });
        query(may_end<F, Pair> ? serial() : *executor_, sink);
    }
    template <class F, class Query> static void with_items(F& visit, const Query& query) {
        ForEachPair sink([&](Pair pair) { return goes_on(visit, pair.b); });
        query(sink);
    }
};

namespace detail {

/// By query, from pairs (query, item) in that order.
AnswersOf<std::uint32_t> answers_of_pairs(std::size_t n_queries, std::span<const Pair> pairs);

/// k answers to each point, of none. Throws std::length_error for more than memory holds.
std::vector<Neighbour> neighbours_of(std::size_t n_points, std::size_t k);

/// That of the options: `given`, else one of so many threads. Throws std::invalid_argument for both
/// and for no threads.
std::shared_ptr<const Executor> executor_of(std::shared_ptr<const Executor> given,
                                            unsigned threads);

} // namespace detail
} // namespace boxwood
