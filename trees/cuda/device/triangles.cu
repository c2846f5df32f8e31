#include "trees/cuda/triangles/triangles.cuh"

#include "trees/cuda/device/counted.cuh"
#include "trees/cuda/triangles/triangle_distances.cuh"
#include "trees/device_triangles.h"

namespace boxwood {
namespace {

using namespace cuda;

static_assert(static_cast<int>(Accuracy::exact) == static_cast<int>(DeviceAccuracy::exact));

TrianglesView view_of(const DeviceTriangles& triangles) {
    return {triangles.vertices.data,
            reinterpret_cast<const std::uint32_t*>(triangles.corners.data)};
}

/// By one thread.
__global__ void begin_pairs(std::uint64_t* n, std::uint64_t n_pairs, UncertainPairs* uncertain) {
    *n = n_pairs;
    *uncertain = {};
}

/// A list of pairs, and what their kernels need beside their answers.
struct Listed {
    Stream stream;
    DeviceArray<std::uint64_t> n;
    DeviceArray<UncertainPairs> uncertain;
    DeviceArray<std::uint32_t> places; ///< of the uncertain, where the level has some
    Candidates candidates{};

    Listed(DeviceSpan<const Pair> pairs, DeviceAccuracy accuracy, std::size_t more_bytes,
           const DevicePlace& place)
        : stream(stream_of(place)) {
        const bool has_uncertain = accuracy >= DeviceAccuracy::certified;
        const std::uint32_t n_pairs = number_of_queries(pairs.size);
        require_memory("pairs of triangles",
                       std::uint64_t{n_pairs} * (more_bytes + (has_uncertain ? 4 : 0)) + 1024);
        n = DeviceArray<std::uint64_t>(1, place);
        uncertain = DeviceArray<UncertainPairs>(1, place);
        if (has_uncertain)
            places = DeviceArray<std::uint32_t>(n_pairs, place);
        launch(stream, 1, 1, begin_pairs, n.span().data, std::uint64_t{n_pairs},
               uncertain.span().data);
        candidates = {pairs.data, n.span().data, n_pairs};
    }
    Uncertain open() { return {places.span().data, &uncertain.span().data->n}; }
    std::uint32_t* in_longest() { return &uncertain.span().data->in_longest; }
};

DeviceArray<Answer> decide(const DeviceTriangles& a, const DeviceTriangles& b, Listed& listed,
                           DeviceAccuracy accuracy, const DevicePlace& place) {
    DeviceArray<Answer> answers(listed.candidates.room, place);
    intersect_triangles(static_cast<Accuracy>(accuracy),
                        {view_of(a), view_of(b), listed.candidates, answers.span().data,
                         listed.open(), listed.in_longest()},
                        listed.stream);
    return answers;
}

} // namespace

DevicePairAnswers<Answer> triangles_touch(const DeviceTriangles& a, const DeviceTriangles& b,
                                          DeviceSpan<const Pair> pairs, DeviceAccuracy accuracy,
                                          DevicePlace place) {
    const Chosen chosen(place.index);
    Listed listed(pairs, accuracy, sizeof(Answer), place);
    DeviceArray<Answer> answers = decide(a, b, listed, accuracy, place);
    return {std::move(answers), std::move(listed.uncertain)};
}

DeviceArray<Pair> touching_pairs(const DeviceTriangles& a, const DeviceTriangles& b,
                                 DeviceSpan<const Pair> pairs, DeviceAccuracy accuracy,
                                 DevicePlace place) {
    const Chosen chosen(place.index);
    Listed listed(pairs, accuracy, sizeof(Answer) + sizeof(Pair) + 1, place);
    const DeviceArray<Answer> answers = decide(a, b, listed, accuracy, place);
    DeviceArray<std::uint32_t> at(blocks_for(pairs.size, triangle_threads), place);
    DeviceArray<std::uint64_t> n(1, place);
    DeviceArray<Pair> found(pairs.size, place);
    compact_hits(
        {answers.span().data, listed.candidates, at.span().data, found.span().data, n.span().data},
        listed.stream);
    found.shrink(number_at(static_cast<const std::uint64_t*>(n.span().data), listed.stream));
    return found;
}

DevicePairAnswers<DistanceBounds> triangle_distances(const DeviceTriangles& a,
                                                     const DeviceTriangles& b,
                                                     DeviceSpan<const Pair> pairs,
                                                     DeviceAccuracy accuracy, DevicePlace place) {
    const Chosen chosen(place.index);
    Listed listed(pairs, accuracy, sizeof(DistanceBounds), place);
    DeviceArray<DistanceBounds> bounds(pairs.size, place);
    measure_triangles(static_cast<Accuracy>(accuracy),
                      {view_of(a), view_of(b), listed.candidates, bounds.span().data, listed.open(),
                       listed.in_longest()},
                      listed.stream);
    return {std::move(bounds), std::move(listed.uncertain)};
}

} // namespace boxwood
