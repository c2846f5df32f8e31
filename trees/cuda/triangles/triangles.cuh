#pragma once

#include "kernels/triangle_triangle/float_pair.h"
#include "trees/cuda/launch.h"
#include "trees/queries/sinks.h"

namespace boxwood::cuda {

/// Triangles on the device: of an indexed mesh, or without `corners` three vertices each.
struct TrianglesView {
    const Vec3<float>* vertices;
    const std::uint32_t* corners; ///< three by triangle, or null

    __device__ Triangle<float> operator[](std::uint32_t i) const {
        const std::size_t at = std::size_t{3} * i;
        return corners ? Triangle<float>{vertices[corners[at]], vertices[corners[at + 1]],
                                         vertices[corners[at + 2]]}
                       : Triangle<float>{vertices[at], vertices[at + 1], vertices[at + 2]};
    }
};

/// Pairs as the kernels that find them leave them (PairsTo): *n of them, but those beyond `room`
/// were lost. room < 2^32; more pairs are done in slabs.
struct Candidates {
    const Pair* pairs;
    const std::uint64_t* n;
    std::uint32_t room;

    __device__ std::uint32_t size() const {
        return *n < room ? static_cast<std::uint32_t>(*n) : room;
    }
};

/// Places in the list of candidates that a first kernel could not decide; *n is 0 at first.
struct Uncertain {
    std::uint32_t* places; ///< as many as candidates
    std::uint32_t* n;

    /// By all lanes of a warp.
    __device__ void add(bool is, std::uint32_t place) const {
        const unsigned lanes = __ballot_sync(~0u, is), lane = threadIdx.x % 32;
        if (lanes == 0)
            return;
        std::uint32_t first = 0;
        if (lane == 0)
            first = atomicAdd(n, static_cast<std::uint32_t>(__popc(lanes)));
        first = __shfl_sync(~0u, first, 0);
        if (is)
            places[first + static_cast<unsigned>(__popc(lanes & ((1u << lane) - 1)))] = place;
    }
};

/// What to decide and where to: an Answer by candidate.
struct TrianglePairs {
    TrianglesView a, b;
    Candidates candidates;
    Answer* answers;
    Uncertain uncertain;   ///< filled by certified and exact: what accuracy costs
    std::uint32_t* n_wide; ///< of exact: those whose exponents needed the longest integers
};

/// exact: certified, then what is uncertain in integers (float_pair.h says what each promises).
enum class Accuracy : std::uint8_t { plain, plain_in_doubles, certified, exact };

constexpr unsigned triangle_threads = 256;
/// Each block takes its share of the uncertain, whose number the host does not know.
constexpr std::size_t uncertain_blocks(std::size_t n_blocks) {
    return n_blocks < 1024 ? n_blocks : 1024;
}

/// A thread per candidate.
template <Accuracy accuracy>
__global__ void __launch_bounds__(triangle_threads) decide_triangles(TrianglePairs to) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    Answer answer = Answer::no;
    if (i < to.candidates.size()) {
        const Pair pair = to.candidates.pairs[i];
        const Triangle<float> a = to.a[pair.a], b = to.b[pair.b];
        if constexpr (accuracy == Accuracy::plain)
            answer = float_pair::plain(a, b);
        else if constexpr (accuracy == Accuracy::plain_in_doubles)
            answer = float_pair::plain_in_doubles(a, b);
        else
            answer = float_pair::certified(a, b);
        to.answers[i] = answer;
    }
    if constexpr (accuracy == Accuracy::certified)
        to.uncertain.add(answer == Answer::maybe, i);
}

/// A thread per uncertain candidate, in integers below 2^58 or, if `wide`, those that did not fit.
template <bool wide>
__global__ void __launch_bounds__(triangle_threads) decide_uncertain(TrianglePairs to) {
    using Grid = std::conditional_t<wide, float_pair::WideFloats, float_pair::NarrowFloats>;
    const std::uint32_t n = *to.uncertain.n, step = gridDim.x * blockDim.x;
    for (std::uint32_t k = blockIdx.x * blockDim.x + threadIdx.x; k < n; k += step) {
        const std::uint32_t i = to.uncertain.places[k];
        if (wide && to.answers[i] != Answer::maybe)
            continue;
        const Pair pair = to.candidates.pairs[i];
        bool fits = false;
        to.answers[i] = float_pair::exact_on<Grid>(to.a[pair.a], to.b[pair.b], fits);
        if (wide && fits) // else not finite
            atomicAdd(to.n_wide, 1u);
    }
}

/// Decides all candidates, with nothing on the host: their number need not be known there.
inline void intersect_triangles(Accuracy accuracy, const TrianglePairs& pairs, Stream stream) {
    const std::size_t n_blocks = blocks_for(pairs.candidates.room, triangle_threads);
    const auto run = [&](void (*kernel)(TrianglePairs), std::size_t n) {
        launch(stream, n, triangle_threads, kernel, pairs);
    };
    switch (accuracy) {
    case Accuracy::plain:
        return run(decide_triangles<Accuracy::plain>, n_blocks);
    case Accuracy::plain_in_doubles:
        return run(decide_triangles<Accuracy::plain_in_doubles>, n_blocks);
    case Accuracy::certified:
    case Accuracy::exact:
        run(decide_triangles<Accuracy::certified>, n_blocks);
    }
    if (accuracy == Accuracy::exact) {
        run(decide_uncertain<false>, uncertain_blocks(n_blocks));
        run(decide_uncertain<true>, uncertain_blocks(n_blocks));
    }
}

/// The hits among the candidates, those that may be hits too, in their order.
struct Hits {
    const Answer* answers;
    Candidates candidates;
    std::uint32_t* at; ///< of each block of candidates the number of hits, then of those before it
    Pair* pairs;       ///< as many as candidates
    std::uint64_t* n;
};

/// The lane's hit is the rank-th of the block's `total`. By all threads of a block.
struct HitRank {
    bool is_hit;
    std::uint32_t rank, total;

    __device__ HitRank(const Hits& hits, std::uint32_t i, std::uint32_t* warp_hits)
        : is_hit(i < hits.candidates.size() && hits.answers[i] != Answer::no), rank(0), total(0) {
        const unsigned lanes = __ballot_sync(~0u, is_hit), lane = threadIdx.x % 32;
        if (lane == 0)
            warp_hits[threadIdx.x / 32] = static_cast<std::uint32_t>(__popc(lanes));
        __syncthreads();
        rank = static_cast<std::uint32_t>(__popc(lanes & ((1u << lane) - 1)));
        for (unsigned warp = 0; warp < triangle_threads / 32; ++warp) {
            rank += warp < threadIdx.x / 32 ? warp_hits[warp] : 0;
            total += warp_hits[warp];
        }
    }
};

__global__ void count_hits(Hits hits) {
    __shared__ std::uint32_t warp_hits[triangle_threads / 32];
    const HitRank mine(hits, blockIdx.x * blockDim.x + threadIdx.x, warp_hits);
    if (threadIdx.x == 0)
        hits.at[blockIdx.x] = mine.total;
}

constexpr unsigned sum_threads = 1024;

/// By one block: each number becomes the sum of those before it.
__global__ void __launch_bounds__(sum_threads) sum_hits(Hits hits, std::uint32_t n_blocks) {
    __shared__ std::uint32_t warp_sums[sum_threads / 32];
    const unsigned lane = threadIdx.x % 32, warp = threadIdx.x / 32;
    const auto sum_to_lane = [lane](std::uint32_t sum) {
        for (unsigned step = 1; step < 32; step *= 2) {
            const std::uint32_t lower = __shfl_up_sync(~0u, sum, step);
            sum += lane >= step ? lower : 0;
        }
        return sum;
    };
    std::uint32_t before = 0;
    for (std::uint32_t first = 0; first < n_blocks; first += sum_threads) {
        const std::uint32_t k = first + threadIdx.x, own = k < n_blocks ? hits.at[k] : 0;
        const std::uint32_t of_warp = sum_to_lane(own);
        if (lane == 31)
            warp_sums[warp] = of_warp;
        __syncthreads();
        const std::uint32_t of_warps = sum_to_lane(warp_sums[lane]);
        const std::uint32_t warps_before = warp > 0 ? __shfl_sync(~0u, of_warps, warp - 1) : 0;
        if (k < n_blocks)
            hits.at[k] = before + warps_before + of_warp - own;
        before += __shfl_sync(~0u, of_warps, 31);
        __syncthreads(); // all have read what is now written over
    }
    if (threadIdx.x == 0)
        *hits.n = before;
}

__global__ void put_hits(Hits hits) {
    __shared__ std::uint32_t warp_hits[triangle_threads / 32];
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    const HitRank mine(hits, i, warp_hits);
    if (mine.is_hit)
        hits.pairs[hits.at[blockIdx.x] + mine.rank] = hits.candidates.pairs[i];
}

inline void compact_hits(const Hits& hits, Stream stream) {
    const auto n_blocks =
        static_cast<std::uint32_t>(blocks_for(hits.candidates.room, triangle_threads));
    launch(stream, n_blocks, triangle_threads, count_hits, hits);
    launch(stream, 1, sum_threads, sum_hits, hits, n_blocks);
    launch(stream, n_blocks, triangle_threads, put_hits, hits);
}

} // namespace boxwood::cuda
