#pragma once

#include "trees/executors/chunks.h"
#include "trees/ordering/detail/radix_sort.h"

namespace boxwood::detail {

/// The numbers from 0 below n in order of code(i), a number of so many bits, ties by number: each
/// in the lower 32 bits, below its code. The same on every executor. n is at most 2^32.
template <class Code>
Buffer<std::uint64_t> code_records(std::size_t n, int bits, const Executor& executor,
                                   const Code& code) {
    Buffer<std::uint64_t> records(n), spare(n);
    const std::size_t parts = chunks_for(n, executor);
    executor.for_each(parts, [&](std::size_t p) {
        const ChunkRange range(n, parts, p);
        for (std::size_t i = range.begin; i < range.end; ++i)
            records[i] = std::uint64_t{code(i)} << 32 | i;
    });
    radix_sort(records, spare, 32, 32 + bits, executor);
    return records;
}

} // namespace boxwood::detail
