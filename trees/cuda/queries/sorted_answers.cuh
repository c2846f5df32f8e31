#pragma once

#include "kernels/primitives/ray.h"
#include "trees/cuda/launch.h"
#include "trees/queries/sinks.h"

namespace boxwood::cuda {

/// Threads that work together: part of a warp, or a block of this size.
template <unsigned size> struct Group {
    static_assert(size <= 32 ? 32 % size == 0 : size % 32 == 0);

    __device__ static unsigned rank() { return threadIdx.x % size; }
    __device__ static std::uint64_t index() {
        return (std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x) / size;
    }
    /// What a thread of the group wrote before it, all read after it.
    __device__ static void sync() {
        if constexpr (size > 32)
            __syncthreads();
        else if constexpr (size == 32)
            __syncwarp();
        else
            __syncwarp(((1u << size) - 1) << threadIdx.x % 32 / size * size);
    }
};

/// Sorts x[0], ..., x[n - 1], by a network of comparators that all put the lesser one first: so
/// that none beyond n need to be there. All of the group come here, with the same n.
template <unsigned size, class T, class Before>
__device__ void sort_by_group(T* x, std::uint64_t n, const Before& before) {
    for (std::uint64_t half = 1; half < n; half *= 2) // sorted runs of `half` are merged
        for (std::uint64_t step = half; step > 0; step /= 2) {
            for (std::uint64_t i = Group<size>::rank();; i += size) {
                const std::uint64_t low = ((i & ~(step - 1)) << 1) | (i & (step - 1));
                if (low >= n)
                    break;
                // At first the one as far from the end of its run as `low` is from the beginning.
                const std::uint64_t high = step == half ? low ^ (2 * half - 1) : low + step;
                if (high < n && before(x[high], x[low])) {
                    const T lower = x[high];
                    x[high] = x[low];
                    x[low] = lower;
                }
            }
            Group<size>::sync();
        }
}

/// The order of answers in that of the CPU.
struct BeforeInAnswers {
    __device__ bool operator()(std::uint32_t a, std::uint32_t b) const { return a < b; }
    __device__ bool operator()(const RayHit& a, const RayHit& b) const {
        return a.t != b.t ? a.t < b.t : a.triangle < b.triangle;
    }
};

constexpr unsigned sort_threads = 256, short_group = 8, max_long_groups = 1024;
constexpr std::uint64_t max_short_answers = 256;

/// Eight threads per query that has few answers, or a block for each in turn that has many.
template <bool many, class Answer>
__global__ void sort_each(const std::uint64_t* at, std::uint32_t parts, std::uint32_t n_queries,
                          Answer* answers) {
    constexpr unsigned size = many ? sort_threads : short_group;
    const std::uint64_t groups = std::uint64_t{gridDim.x} * (sort_threads / size);
    for (std::uint64_t query = Group<size>::index(); query < n_queries; query += groups) {
        const std::uint64_t* const place = at + query * parts;
        const std::uint64_t first = place[0], n = place[parts] - first;
        if ((n > max_short_answers) == many)
            sort_by_group<size>(answers + first, n, BeforeInAnswers{});
    }
}

/// Puts the answers of each query, at[query * parts] to at[(query + 1) * parts], into the order of
/// the CPU: items ascending; hits by t and then by triangle.
template <class Answer>
void sort_answers(const std::uint64_t* at, std::uint32_t n_queries, Answer* answers, Stream stream,
                  std::uint32_t parts = 1) {
    const std::size_t blocks = blocks_for(n_queries, sort_threads / short_group);
    launch(stream, blocks, sort_threads, sort_each<false, Answer>, at, parts, n_queries, answers);
    launch(stream, n_queries < max_long_groups ? n_queries : max_long_groups, sort_threads,
           sort_each<true, Answer>, at, parts, n_queries, answers);
}

} // namespace boxwood::cuda
