#include "trees/ordering/detail/bucket_sort.h"
#include "trees/buffer.h"
#include "trees/executors/chunks.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <numeric>
#include <vector>

namespace boxwood::detail {
namespace {

constexpr std::uint32_t block = 16; ///< buckets of fewer items are not split any further
constexpr std::uint32_t alike = 8;  ///< more items of one code than this are counted

void insertion_sort(std::uint64_t* begin, std::uint64_t* end) {
    for (std::uint64_t* at = begin + 1; at < end; ++at) {
        const std::uint64_t record = *at;
        std::uint64_t* to = at;
        for (; to > begin && to[-1] > record; --to)
            *to = to[-1];
        *to = record;
    }
}

/// Sorts n records, whose codes are from `low` up and differ by less than 2^bits, from `from` to
/// `to`; what `from` holds afterwards is of no use. Returns as bucket_sort does.
/// Each step takes at least five bits, or all: the recursion is no deeper than seven.
std::size_t sort_part(std::uint64_t* from, std::uint64_t* to, std::uint32_t n, std::uint64_t low,
                      int bits, Sorted how) {
    constexpr int max_digit = 12; // as many counters fill a third of the first level of cache
    const int digit = std::min({bits, max_digit, static_cast<int>(std::bit_width(n))});
    const int rest = bits - digit, shift = 32 + rest;
    const std::size_t buckets = std::size_t{1} << digit;
    const std::uint64_t base = low << 32;
    std::array<std::uint32_t, std::size_t{1} << max_digit> ends;
    std::fill_n(ends.begin(), buckets, 0u);
    for (std::uint32_t i = 0; i < n; ++i)
        ++ends[(from[i] - base) >> shift];
    std::uint32_t at = 0, largest = 0;
    for (std::size_t b = 0; b < buckets; ++b) {
        largest = std::max(largest, ends[b]);
        at += std::exchange(ends[b], at);
    }
    for (std::uint32_t i = 0; i < n; ++i)
        to[ends[(from[i] - base) >> shift]++] = from[i];

    const auto for_buckets = [&](const auto& f) {
        std::uint32_t begin = 0;
        for (std::size_t b = 0; b < buckets; begin = ends[b++])
            f(b, begin, ends[b]);
    };
    std::size_t in_long = 0;
    if (rest == 0) {
        if (largest > alike)
            for_buckets([&](std::size_t, std::uint32_t begin, std::uint32_t end) {
                in_long += end - begin > alike ? end - begin : 0;
            });
    } else if (largest >= block) {
        for_buckets([&](std::size_t b, std::uint32_t begin, std::uint32_t end) {
            if (end - begin >= block) {
                std::copy(to + begin, to + end, from + begin);
                in_long += sort_part(from + begin, to + begin, end - begin,
                                     low + (std::uint64_t{b} << rest), rest, how);
            } else if (how == Sorted::exactly) {
                insertion_sort(to + begin, to + end);
            }
        });
    } else if (how == Sorted::exactly) {
        insertion_sort(to, to + n);
    }
    return in_long;
}

std::uint64_t record_of(std::uint32_t code, std::size_t item) {
    return std::uint64_t{code} << 32 | item;
}

constexpr int cell_bits = 12;
constexpr std::size_t cells = std::size_t{1} << cell_bits;

/// Ranges of cells, by the leading bits of the codes, of about as many items each. A part ends
/// where the next cell would make it too large, so two neighbours hold more than `goal` items.
struct Parts {
    /// counts[c][i]: items of cell i in chunk c.
    Parts(std::size_t n, std::span<const std::array<std::uint32_t, cells>> counts) {
        // Streams of about a cache line each that the second level of cache and the TLB can hold.
        const std::size_t goal = std::max<std::size_t>(n / 512, 256);
        std::size_t in_part = 0, at = 0;
        for (std::size_t cell = 0; cell < cells; ++cell) {
            std::size_t in_cell = 0;
            for (const auto& of_chunk : counts)
                in_cell += of_chunk[cell];
            if (first.empty() || in_part + in_cell > goal) {
                first_cell.push_back(cell);
                first.push_back(at);
                in_part = 0;
            }
            part_of[cell] = static_cast<std::uint16_t>(first.size() - 1);
            in_part += in_cell;
            at += in_cell;
        }
        first_cell.push_back(cells);
        first.push_back(n);
        // Within a part those of the first chunk come first.
        next.resize(counts.size(), std::vector<std::uint32_t>(size()));
        for (std::size_t c = 0; c < counts.size(); ++c)
            for (std::size_t cell = 0; cell < cells; ++cell)
                next[c][part_of[cell]] += counts[c][cell];
        std::uint32_t slot = 0;
        for (std::size_t p = 0; p < size(); ++p)
            for (auto& of_chunk : next)
                slot += std::exchange(of_chunk[p], slot);
    }
    std::size_t size() const { return first.size() - 1; }

    std::array<std::uint16_t, cells> part_of;
    std::vector<std::size_t> first_cell, first;   ///< of each part, and one more
    std::vector<std::vector<std::uint32_t>> next; ///< [chunk][part]: slot of the next record
};

} // namespace

std::size_t bucket_sort(std::size_t n, int bits, CodesOfItems codes_of, Sorted how,
                        const Executor& executor, PutRecords put) {
    constexpr std::size_t batch = 1024, small = 2048;
    if (n == 0)
        return 0;
    Buffer<std::uint32_t> codes(n);
    Buffer<std::uint64_t> records(n);
    if (n <= small) {
        codes_of(0, codes.span());
        for (std::size_t i = 0; i < n; ++i)
            records[i] = record_of(codes[i], i);
        Buffer<std::uint64_t> sorted(n);
        const std::size_t in_long =
            sort_part(records.data(), sorted.data(), static_cast<std::uint32_t>(n), 0, bits, how);
        put(0, sorted.span(), in_long);
        return in_long;
    }
    const int shift = bits - cell_bits;
    const std::size_t chunks = chunks_for(n, executor);
    std::vector<std::array<std::uint32_t, cells>> counts(chunks);
    executor.for_each(chunks, [&](std::size_t c) {
        std::uint32_t* const count = counts[c].data();
        const int cell = shift;
        const ChunkRange range(n, chunks, c);
        for (std::size_t begin = range.begin; begin < range.end; begin += batch) {
            const auto some = codes.span().subspan(begin, std::min(batch, range.end - begin));
            codes_of(begin, some);
            for (const std::uint32_t code : some)
                ++count[code >> cell];
        }
    });
    Parts parts(n, counts);
    executor.for_each(chunks, [&](std::size_t c) {
        std::uint32_t* const next = parts.next[c].data();
        const std::uint16_t* const part_of = parts.part_of.data();
        const std::uint32_t* const from = codes.data();
        std::uint64_t* const to = records.data();
        const int cell = shift;
        const ChunkRange range(n, chunks, c);
        for (std::size_t i = range.begin; i < range.end; ++i)
            to[next[part_of[from[i] >> cell]]++] = record_of(from[i], i);
    });
    constexpr std::size_t max_tasks = 64;
    const std::size_t tasks = chunks == 1 ? 1 : std::min(parts.size(), max_tasks);
    std::atomic<std::size_t> in_long = 0;
    executor.for_each(tasks, [&](std::size_t t) {
        const ChunkRange range(parts.size(), tasks, t);
        std::size_t largest = 0;
        for (std::size_t p = range.begin; p < range.end; ++p)
            largest = std::max(largest, parts.first[p + 1] - parts.first[p]);
        Buffer<std::uint64_t> sorted(largest);
        std::size_t in_long_here = 0;
        for (std::size_t p = range.begin; p < range.end; ++p) {
            const std::size_t first = parts.first[p], count = parts.first[p + 1] - first;
            const std::size_t wide = parts.first_cell[p + 1] - parts.first_cell[p];
            const std::size_t in_long_of_part =
                sort_part(records.data() + first, sorted.data(), static_cast<std::uint32_t>(count),
                          std::uint64_t{parts.first_cell[p]} << shift,
                          shift + static_cast<int>(std::bit_width(wide - 1)), how);
            put(first, sorted.span().first(count), in_long_of_part);
            in_long_here += in_long_of_part;
        }
        in_long += in_long_here;
    });
    return in_long;
}

} // namespace boxwood::detail
