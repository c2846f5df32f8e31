#pragma once

#include "kernels/triangle_distance/float_pair.h"
#include "trees/cuda/triangles/triangles.cuh"

namespace boxwood::cuda {

using float_pair::Bounds;

/// What to measure and where to: bounds by candidate, for plain ones lo = hi.
struct TriangleDistances {
    TrianglesView a, b;
    Candidates candidates;
    Bounds* bounds;
    Uncertain uncertain;   ///< those whose bounds certified leaves wide, and exact narrows
    std::uint32_t* n_wide; ///< of exact: those whose exponents needed the longest integers
};

/// A thread per candidate.
template <Accuracy accuracy>
__global__ void __launch_bounds__(triangle_threads) measure_triangles(TriangleDistances to) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    bool sure = true;
    if (i < to.candidates.size()) {
        const Pair pair = to.candidates.pairs[i];
        const Triangle<float> a = to.a[pair.a], b = to.b[pair.b];
        if constexpr (accuracy == Accuracy::certified) {
            to.bounds[i] = float_pair::certified_distance(a, b, sure);
        } else {
            using Real = std::conditional_t<accuracy == Accuracy::plain, float, double>;
            const double d = float_pair::plain_distance<Real>(a, b);
            to.bounds[i] = {d, d};
        }
    }
    if constexpr (accuracy == Accuracy::certified)
        to.uncertain.add(!sure, i);
}

/// A thread per uncertain candidate, in integers of 64 bits by coordinate, or of 320 those that
/// need them.
template <int words>
__global__ void __launch_bounds__(triangle_threads) measure_uncertain(TriangleDistances to) {
    constexpr bool wide = words > 1;
    const std::uint32_t n = *to.uncertain.n, step = gridDim.x * blockDim.x;
    for (std::uint32_t k = blockIdx.x * blockDim.x + threadIdx.x; k < n; k += step) {
        const std::uint32_t i = to.uncertain.places[k];
        const Pair pair = to.candidates.pairs[i];
        const Triangle<float> a = to.a[pair.a], b = to.b[pair.b];
        int low = 0;
        if (wide && float_pair::WholeCorners<1>::holds(a, b, low))
            continue; // already measured
        if (float_pair::exact_distance<words>(a, b, to.bounds[i]) && wide)
            atomicAdd(to.n_wide, 1u);
    }
}

/// Measures all candidates, with nothing on the host: their number need not be known there.
inline void measure_triangles(Accuracy accuracy, const TriangleDistances& pairs, Stream stream) {
    const std::size_t n_blocks = blocks_for(pairs.candidates.room, triangle_threads);
    const auto run = [&](void (*kernel)(TriangleDistances), std::size_t n) {
        launch(stream, n, triangle_threads, kernel, pairs);
    };
    switch (accuracy) {
    case Accuracy::plain:
        return run(measure_triangles<Accuracy::plain>, n_blocks);
    case Accuracy::plain_in_doubles:
        return run(measure_triangles<Accuracy::plain_in_doubles>, n_blocks);
    case Accuracy::certified:
    case Accuracy::exact:
        run(measure_triangles<Accuracy::certified>, n_blocks);
    }
    if (accuracy == Accuracy::exact) {
        run(measure_uncertain<1>, uncertain_blocks(n_blocks));
        run(measure_uncertain<5>, uncertain_blocks(n_blocks));
    }
}

/// The least distance of all: bounds of it, as bits of doubles (of those that are not negative in
/// the same order), and the first candidate with that upper bound. All bits set: none.
struct Least {
    unsigned long long lo, hi;
    std::uint32_t place;
};
constexpr Least no_least{~0ull, ~0ull, ~0u};

/// A thread per candidate; *least is no_least at first. NaN is skipped, as the largest.
__global__ void find_least(const Bounds* bounds, Candidates candidates, Least* least) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    Least mine = no_least;
    if (i < candidates.size()) {
        const Bounds own = bounds[i];
        if (own.hi == own.hi) {
            mine.lo = bits_as<unsigned long long>(own.lo);
            mine.hi = bits_as<unsigned long long>(own.hi);
        }
    }
    for (unsigned step = 16; step > 0; step /= 2) {
        const unsigned long long lo = __shfl_xor_sync(~0u, mine.lo, step),
                                 hi = __shfl_xor_sync(~0u, mine.hi, step);
        mine.lo = lo < mine.lo ? lo : mine.lo;
        mine.hi = hi < mine.hi ? hi : mine.hi;
    }
    if (threadIdx.x % 32 == 0 && mine.hi != no_least.hi) {
        atomicMin(&least->lo, mine.lo);
        atomicMin(&least->hi, mine.hi);
    }
}
__global__ void find_place_of_least(const Bounds* bounds, Candidates candidates, Least* least) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < candidates.size() && bits_as<unsigned long long>(bounds[i].hi) == least->hi)
        atomicMin(&least->place, i);
}

inline void least_distance(const Bounds* bounds, const Candidates& candidates, Least* least,
                           Stream stream) {
    const std::size_t n_blocks = blocks_for(candidates.room, triangle_threads);
    launch(stream, n_blocks, triangle_threads, find_least, bounds, candidates, least);
    launch(stream, n_blocks, triangle_threads, find_place_of_least, bounds, candidates, least);
}

} // namespace boxwood::cuda
