#include "trees/queries/box_queries.h"

#include <stdexcept>

namespace boxwood {
namespace {

template <class Query> std::vector<Pair> pairs_of(const Query& query) {
    std::vector<Pair> pairs;
    AppendPairs sink(pairs);
    query(sink);
    return pairs;
}

template <class Query> std::uint64_t count_of(const Query& query) {
    CountPairs sink;
    query(sink);
    return sink.count();
}

template <class Query> AnswersOf<std::uint32_t> answers_of(std::size_t n, const Query& query) {
    return detail::answers_of_pairs(n, pairs_of(query));
}

} // namespace

AnswersOf<std::uint32_t> detail::answers_of_pairs(std::size_t n_queries,
                                                  std::span<const Pair> pairs) {
    AnswersOf<std::uint32_t> answers{std::vector<std::uint64_t>(n_queries + 1),
                                     std::vector<std::uint32_t>(pairs.size())};
    std::size_t found = 0;
    for (std::size_t i = 0; i < n_queries; ++i) {
        for (; found < pairs.size() && pairs[found].a == i; ++found)
            answers.of[found] = pairs[found].b;
        answers.offsets[i + 1] = found;
    }
    return answers;
}

std::vector<Pair> BoxQueries::self_pairs() const {
    return pairs_of([&](PairSink& sink) { self_pairs(sink); });
}
std::uint64_t BoxQueries::self_pair_count() const {
    return count_of([&](PairSink& sink) { self_pairs(sink); });
}
std::vector<Pair> BoxQueries::pairs(const BoxQueries& other) const {
    return pairs_of([&](PairSink& sink) { pairs(other, sink); });
}
std::uint64_t BoxQueries::pair_count(const BoxQueries& other) const {
    return count_of([&](PairSink& sink) { pairs(other, sink); });
}

std::vector<std::uint32_t> BoxQueries::overlapping(const Box& box) const {
    std::vector<std::uint32_t> items;
    overlapping(box, [&](std::uint32_t item) { items.push_back(item); });
    return items;
}
std::vector<std::uint32_t> BoxQueries::overlapping(const Sphere<float>& ball) const {
    std::vector<std::uint32_t> items;
    overlapping(ball, [&](std::uint32_t item) { items.push_back(item); });
    return items;
}
std::vector<std::uint32_t> BoxQueries::containing(Vec3<float> point) const {
    std::vector<std::uint32_t> items;
    containing(point, [&](std::uint32_t item) { items.push_back(item); });
    return items;
}

AnswersOf<std::uint32_t> BoxQueries::overlapping(Boxes boxes) const {
    return answers_of(boxes.size(), [&](PairSink& sink) { overlapping(boxes, sink); });
}
AnswersOf<std::uint32_t> BoxQueries::overlapping(std::span<const Sphere<float>> balls) const {
    return answers_of(balls.size(), [&](PairSink& sink) { overlapping(balls, sink); });
}
AnswersOf<std::uint32_t> BoxQueries::containing(std::span<const Vec3<float>> points) const {
    return answers_of(points.size(), [&](PairSink& sink) { containing(points, sink); });
}

std::vector<Neighbour> BoxQueries::nearest(Vec3<float> point, std::size_t k) const {
    std::vector<Neighbour> found = nearest({&point, 1}, k);
    while (!found.empty() && found.back().item == Neighbour::none)
        found.pop_back();
    return found;
}
std::vector<Neighbour> BoxQueries::nearest(std::span<const Vec3<float>> points,
                                           std::size_t k) const {
    std::vector<Neighbour> found = detail::neighbours_of(points.size(), k);
    layout_->nearest(points, k, *executor_, found);
    return found;
}

std::vector<Neighbour> detail::neighbours_of(std::size_t n_points, std::size_t k) {
    constexpr const char* too_many = "nearest: k answers to each point are more than memory holds";
    std::vector<Neighbour> all;
    if (n_points > 0 && k > all.max_size() / n_points)
        throw std::length_error(too_many);
    try {
        all.resize(k * n_points);
    } catch (const std::bad_alloc&) {
        throw std::length_error(too_many);
    }
    return all;
}

std::shared_ptr<const Executor> detail::executor_of(std::shared_ptr<const Executor> given,
                                                    unsigned threads) {
    if (!given)
        return make_executor(default_executor(threads), threads);
    if (threads != 1)
        throw std::invalid_argument("give threads or an executor, not both");
    return given;
}

} // namespace boxwood
