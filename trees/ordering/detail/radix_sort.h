#pragma once

#include "trees/buffer.h"
#include "trees/executors/chunks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace boxwood::detail {

/// Sorts records by their bits [low, high), least digit first. Stable, so the result is the same
/// for any number of threads. `spare` is of the same size; what it holds afterwards is of no use.
inline void radix_sort(Buffer<std::uint64_t>& records, Buffer<std::uint64_t>& spare, int low,
                       int high, const Executor& executor) {
    // With 2^8 streams to write to, scattering stays within what the core translates at a time;
    // 2^10 or 2^11 took longer in spite of fewer passes.
    constexpr int digit_bits = 8;
    constexpr std::size_t buckets = std::size_t{1} << digit_bits;
    using Counts = std::array<std::uint32_t, buckets>;
    const std::size_t n = records.size(), chunks = chunks_for(n, executor);
    std::vector<Counts> counts(chunks);
    for (int shift = low; shift < high; shift += digit_bits) {
        const std::size_t mask = (std::size_t{1} << std::min(digit_bits, high - shift)) - 1;
        executor.for_each(chunks, [&](std::size_t c) {
            Counts& mine = counts[c];
            mine.fill(0);
            const ChunkRange range(n, chunks, c);
            for (std::size_t i = range.begin; i < range.end; ++i)
                ++mine[records[i] >> shift & mask];
        });
        std::uint32_t at = 0;
        bool sorted = false; // all in one bucket
        for (std::size_t b = 0; b < buckets; ++b) {
            const std::uint32_t before = at;
            for (Counts& of_chunk : counts)
                at += std::exchange(of_chunk[b], at);
            sorted = sorted || at - before == n;
        }
        if (sorted)
            continue;
        executor.for_each(chunks, [&](std::size_t c) {
            std::uint32_t* const next = counts[c].data();
            const std::uint64_t* const from = records.data();
            std::uint64_t* const to = spare.data();
            const ChunkRange range(n, chunks, c);
            for (std::size_t i = range.begin; i < range.end; ++i)
                to[next[from[i] >> shift & mask]++] = from[i];
        });
        std::swap(records, spare);
    }
}

} // namespace boxwood::detail
