#include "trees/ordering/curve_order.h"
#include "trees/executors/chunks.h"
#include "trees/ordering/detail/bucket_sort.h"
#include "trees/ordering/detail/radix_sort.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace boxwood {
using namespace detail;
namespace {

/// Throws as `require_valid`.
Box bounds_of_centres(Boxes boxes, const Executor& executor) {
    const std::size_t chunks = chunks_for(boxes.size(), executor);
    std::vector<CentreBounds> parts(chunks);
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(boxes.size(), chunks, c);
        parts[c] = measure_centres(boxes.subspan(range.begin, range.end - range.begin));
    });
    Box centres;
    bool valid = boxes.size() <= max_items;
    for (const CentreBounds& part : parts) {
        centres.extend(part.box);
        valid = valid && part.valid;
    }
    if (!valid)
        require_valid(boxes); // finds which
    return centres;
}

/// What is sorted, in eight bytes: the leading bits of the code above, the item below.
using Records = Buffer<std::uint64_t>;
std::uint32_t item_of(std::uint64_t record) { return static_cast<std::uint32_t>(record); }

/// Calls f(begin, end) for parts of the items, one part at a time in each thread.
template <class F> void for_parts(std::size_t n, const Executor& executor, const F& f) {
    const std::size_t chunks = chunks_for(n, executor);
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(n, chunks, c);
        f(range.begin, range.end);
    });
}

constexpr std::size_t quickly_sorted = 64; ///< the longest run that is no trouble to sort

/// Items in long runs that may be dealt with run by run.
std::size_t few(std::size_t n) { return n / 8; }

/// Runs of two or more records that agree in all bits from `low` up: for each chunk those that
/// begin in it.
struct Runs {
    /// Runs of more than `longest` count as long.
    Runs(const Records& records, int low, std::size_t longest, const Executor& executor)
        : parts(chunks_for(records.size(), executor)) {
        const std::size_t n = records.size();
        executor.for_each(parts.size(), [&](std::size_t c) {
            const ChunkRange range(n, parts.size(), c);
            const auto continues = [&](std::size_t i) {
                return i > 0 && i < n && (records[i - 1] ^ records[i]) >> low == 0;
            };
            std::size_t i = range.begin;
            while (i < range.end && continues(i))
                ++i;
            for (++i; i <= range.end; ++i)
                if (continues(i)) {
                    const std::size_t begin = i - 1;
                    while (continues(i))
                        ++i;
                    parts[c].emplace_back(begin, i);
                }
        });
        for (const auto& part : parts)
            for (const auto& run : part) {
                const std::size_t length = run.second - run.first;
                items += length;
                in_long += length > longest ? length : 0;
            }
    }
    template <class Less>
    void sort(Records& records, const Less& less, const Executor& executor) const {
        executor.for_each(parts.size(), [&](std::size_t c) {
            for (const auto& run : parts[c])
                std::sort(records.begin() + run.first, records.begin() + run.second, less);
        });
    }
    std::vector<std::vector<std::pair<std::size_t, std::size_t>>> parts;
    std::size_t items = 0, in_long = 0;
};

/// Sorts records that come with their items ascending by their `bits` leading bits (those from 32
/// up), then by `less`: by as many digits as tell most items apart if they are spread out, then the
/// runs that still agree if they are short; else by all bits first. False if then many items are in
/// long runs that agree in all bits.
template <class Less>
bool sort_records(Records& records, int bits, const Less& less, const Executor& executor) {
    const std::size_t n = records.size();
    Records spare(n);
    const int enough = (static_cast<int>(std::bit_width(n)) + 4 + 7) / 8 * 8;
    const int low = 32 + std::max(0, bits - enough);
    radix_sort(records, spare, low, 32 + bits, executor);
    const Runs runs(records, low, quickly_sorted, executor);
    if (runs.in_long <= few(n)) {
        runs.sort(records, less, executor);
        if (low == 32 || runs.items <= few(n))
            return true;
    } else {
        radix_sort(records, spare, 32, 32 + bits, executor);
    }
    const Runs rest(records, 32, quickly_sorted, executor);
    if (rest.in_long > few(n))
        return false;
    rest.sort(records, less, executor);
    return true;
}

} // namespace

CurveOrder curve_order(Boxes boxes, Curve curve, const Executor& executor) {
    const std::size_t n = boxes.size();
    const CurveGrid grid = curve_grid(bounds_of_centres(boxes, executor), 21);
    Buffer<std::uint64_t> codes(n);
    Records records(n);
    constexpr int upper = 32, lower = 31; // bits of a code, sorted in two rounds if need be
    for_parts(n, executor, [&](std::size_t begin, std::size_t end) {
        fine_codes(boxes.subspan(begin, end - begin), curve, grid, codes.data() + begin);
        for (std::size_t i = begin; i < end; ++i)
            records[i] = codes[i] >> lower << 32 | i;
    });
    const auto less = [&](std::uint64_t a, std::uint64_t b) {
        const std::uint64_t code_a = codes[item_of(a)], code_b = codes[item_of(b)];
        return code_a < code_b || (code_a == code_b && item_of(a) < item_of(b));
    };
    if (!sort_records(records, upper, less, executor)) {
        Records spare(n);
        for_parts(n, executor, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                records[i] = codes[i] << 32 | i; // the bit above the lower ones is not sorted by
        });
        radix_sort(records, spare, 32, 32 + lower, executor);
        for_parts(n, executor, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                records[i] = codes[item_of(records[i])] >> lower << 32 | item_of(records[i]);
        });
        radix_sort(records, spare, 32, 32 + upper, executor);
    }
    CurveOrder result{Buffer<std::uint64_t>(n), Buffer<std::uint32_t>(n)};
    for_parts(n, executor, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            result.order[i] = item_of(records[i]);
            result.codes[i] = codes[result.order[i]];
        }
    });
    return result;
}

namespace {

void grouped_codes(Boxes boxes, Curve curve, const CurveGrid& grid, GroupOfBox group,
                   std::uint32_t* codes) {
    coarse_codes(boxes, curve, grid, codes);
    if (group)
        for (std::size_t i = 0; i < boxes.size(); ++i)
            codes[i] |= group(boxes[i]) << 30;
}

/// Sorts by group and by 10 bits per axis. Returns how many items are in the same cell as eight
/// others or more.
std::size_t coarse_sort(Boxes boxes, Curve curve, const CurveGrid& grid, GroupOfBox group,
                        Sorted how, const Executor& executor, PutRecords put) {
    const auto codes = [&](std::size_t first, std::span<std::uint32_t> to) {
        grouped_codes(boxes.subspan(first, to.size()), curve, grid, group, to.data());
    };
    return bucket_sort(boxes.size(), group ? 32 : 30, codes, how, executor, put);
}

CurveGrid coarse_grid(Boxes boxes, const Executor& executor, const Box* centres) {
    return curve_grid(centres ? *centres : bounds_of_centres(boxes, executor), 10);
}

/// Slots of items that are in one cell of a coarse grid.
struct Crowd {
    static constexpr std::size_t fewest = 33; ///< two blocks of sixteen need no order among them
    std::size_t first, count;
};

class Crowds {
  public:
    /// Those among sorted records, which stand from slot `first` on.
    void find(std::size_t first, std::span<const std::uint64_t> records) {
        for (std::size_t i = 0, end = 0; i < records.size(); i = end) {
            for (end = i + 1; end < records.size() && (records[i] ^ records[end]) >> 32 == 0;)
                ++end;
            if (end - i >= Crowd::fewest) {
                const std::scoped_lock lock(mutex_);
                all_.push_back({first + i, end - i});
            }
        }
    }
    /// The largest first.
    std::span<const Crowd> sorted() {
        std::ranges::sort(all_, std::greater<>(),
                          [](const Crowd& crowd) { return std::pair(crowd.count, crowd.first); });
        return all_;
    }

  private:
    std::mutex mutex_;
    std::vector<Crowd> all_;
};

Buffer<std::uint32_t> order_by(Boxes boxes, Curve curve, GroupOfBox group, Sorted how,
                               const Executor& executor, const Box* centres);

/// Puts the items in these slots in order by a grid around their own centres.
void order_crowd(Boxes boxes, Curve curve, Sorted how, std::span<std::uint32_t> slots,
                 const Executor& executor) {
    const std::vector<std::uint32_t> items(slots.begin(), slots.end());
    Buffer<Box> own(items.size());
    for_parts(items.size(), executor, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            own[i] = boxes[items[i]];
    });
    const Buffer<std::uint32_t> order =
        order_by(own.span(), curve, nullptr, how, executor, nullptr);
    std::ranges::transform(order, slots.begin(), [&](std::uint32_t i) { return items[i]; });
}

/// By a grid of 2^10 cells along each axis; the items of a cell that holds many by a grid in that
/// cell, and so on. Each time the grid is a thousandth as wide: floats have room for 28 grids.
Buffer<std::uint32_t> order_by(Boxes boxes, Curve curve, GroupOfBox group, Sorted how,
                               const Executor& executor, const Box* centres) {
    Buffer<std::uint32_t> order(boxes.size());
    Crowds crowds;
    const auto put = [&](std::size_t first, std::span<const std::uint64_t> records,
                         std::size_t alike) {
        std::ranges::transform(records, order.data() + first, item_of);
        if (alike >= Crowd::fewest)
            crowds.find(first, records);
    };
    const CurveGrid grid = coarse_grid(boxes, executor, centres);
    coarse_sort(boxes, curve, grid, group, how, executor, put);
    if (grid.scale == 0)
        return order; // all centres are the same
    constexpr std::size_t large = 1 << 15;
    std::span<const Crowd> rest = crowds.sorted();
    const auto order_one = [&](const Crowd& crowd, const Executor& with) {
        if (crowd.count < boxes.size())
            order_crowd(boxes, curve, how, order.span().subspan(crowd.first, crowd.count), with);
    };
    for (; !rest.empty() && rest.front().count > large; rest = rest.subspan(1))
        order_one(rest.front(), executor);
    executor.for_each(rest.size(), [&](std::size_t i) { order_one(rest[i], serial()); });
    return order;
}

} // namespace

MergeableOrder mergeable_curve_order(Boxes boxes, Curve curve, GroupOfBox group,
                                     const Executor& executor, const Box* centres) {
    MergeableOrder kept{coarse_grid(boxes, executor, centres), group, Records(boxes.size())};
    const auto put = [&](std::size_t first, std::span<const std::uint64_t> records, std::size_t) {
        std::ranges::copy(records, kept.records.data() + first);
    };
    if (coarse_sort(boxes, curve, kept.grid, group, Sorted::exactly, executor, put) >
        few(boxes.size()))
        kept.records = {};
    return kept;
}

void curve_records(Boxes boxes, Curve curve, const CurveGrid& grid, GroupOfBox group,
                   std::uint64_t* records) {
    constexpr std::size_t batch = 1024;
    std::uint32_t codes[batch];
    for (std::size_t first = 0; first < boxes.size(); first += batch) {
        const std::size_t some = std::min(batch, boxes.size() - first);
        grouped_codes(boxes.subspan(first, some), curve, grid, group, codes);
        for (std::size_t i = 0; i < some; ++i)
            records[first + i] = std::uint64_t{codes[i]} << 32 | (first + i);
    }
}

Buffer<std::uint32_t> coarse_curve_order(Boxes boxes, Curve curve, const Executor& executor) {
    return order_by(boxes, curve, nullptr, Sorted::exactly, executor, nullptr);
}

Buffer<std::uint32_t> block_curve_order(Boxes boxes, Curve curve, GroupOfBox group,
                                        const Executor& executor, const Box* centres) {
    return order_by(boxes, curve, group, Sorted::in_blocks, executor, centres);
}

} // namespace boxwood
