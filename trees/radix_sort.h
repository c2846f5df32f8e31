#pragma once

#include "trees/buffer.h"
#include "trees/executor.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace boxwood {

/// The range [begin, end) of chunk c when n entries are cut into `chunks` parts of about equal
/// size.
struct ChunkRange {
    ChunkRange(std::size_t n, std::size_t chunks, std::size_t c)
        : begin(n * c / chunks), end(n * (c + 1) / chunks) {}
    std::size_t begin, end;
};

/// Parts for a pass over n entries whose result does not depend on how it is cut: one per thread,
/// and one alone where handing out work would cost more than the pass.
inline std::size_t chunks_for(std::size_t n, const Executor& executor) {
    constexpr std::size_t least = 8192;
    return std::clamp<std::size_t>(n / least, 1, executor.threads());
}

/// Sorts records by bits [low, high) of `record.key()`, least digit first. Stable, so the result is
/// the same for any number of threads. `spare` is of the same size; what it holds afterwards is of
/// no use.
template <class Record, int digit_bits>
void radix_sort(Buffer<Record>& records, Buffer<Record>& spare, int low, int high,
                const Executor& executor) {
    constexpr std::size_t buckets = std::size_t{1} << digit_bits;
    using Counts = std::array<std::uint32_t, buckets>;
    const std::size_t n = records.size(), chunks = chunks_for(n, executor);
    const auto digit = [](const Record& record, int shift) {
        return static_cast<std::size_t>(record.key() >> shift) & (buckets - 1);
    };
    std::vector<Counts> counts(chunks);
    for (int shift = low; shift < high; shift += digit_bits) {
        executor.for_each(chunks, [&](std::size_t c) {
            Counts& mine = counts[c];
            mine.fill(0);
            const ChunkRange range(n, chunks, c);
            for (std::size_t i = range.begin; i < range.end; ++i)
                ++mine[digit(records[i], shift)];
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
            Counts& to = counts[c];
            const ChunkRange range(n, chunks, c);
            for (std::size_t i = range.begin; i < range.end; ++i)
                spare[to[digit(records[i], shift)]++] = records[i];
        });
        std::swap(records, spare);
    }
}

} // namespace boxwood
