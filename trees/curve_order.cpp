// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/curve_order.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/curve_order.h"
#include "trees/radix_sort.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#ifndef BOXWOOD_CURVE_GRID
#define BOXWOOD_CURVE_GRID
namespace boxwood {

/// Bounds of the centres of some boxes, and whether all of the boxes are valid.
struct CentreBounds {
    Box box;
    bool valid = true;
};

} // namespace boxwood
#endif

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::ScalableTag<float> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;

inline void AddCentre(const Box& box, CentreBounds& to) {
    to.box.extend(.5f * box.min + .5f * box.max);
    to.valid = to.valid && box.is_valid();
}

/// The boxes are read as a row of floats. In three registers every place has the same coordinate
/// each time (registers hold 4, 8 or 16 floats, a box 6), so no lane ever changes place; those that
/// would add a box's max to the next box's min are left out at the end.
CentreBounds MeasureCentres(Boxes boxes) {
    CentreBounds result;
    constexpr std::size_t lanes = HWY_MAX_BYTES / sizeof(float);
    std::size_t done = 0;
    if constexpr (lanes >= 4) {
        const float* const row = reinterpret_cast<const float*>(boxes.data());
        constexpr std::size_t step = lanes / 2; // boxes in three registers
        const auto half = hn::Set(df, .5f);
        auto low0 = hn::Set(df, result.box.min.x), low1 = low0, low2 = low0;
        auto high0 = hn::Set(df, result.box.max.x), high1 = high0, high2 = high0;
        // 0 while all is finite and min <= max; else negative or NaN.
        auto bad0 = hn::Zero(df), bad1 = bad0, bad2 = bad0;
        const auto add = [&](const float* at, auto& low, auto& high, auto& bad) HWY_ATTR {
            const auto v = hn::LoadU(df, at), w = hn::LoadU(df, at + 3);
            const auto centre = hn::Add(hn::Mul(v, half), hn::Mul(w, half));
            low = hn::Min(low, centre);
            high = hn::Max(high, centre);
            const auto ordered = hn::Min(hn::Sub(w, v), hn::Zero(df));
            bad = hn::Add(bad, hn::Add(ordered, hn::Sub(centre, centre)));
        };
        for (; done + step + 1 <= boxes.size(); done += step) {
            const float* const at = row + 6 * done;
            add(at, low0, high0, bad0);
            add(at + lanes, low1, high1, bad1);
            add(at + 2 * lanes, low2, high2, bad2);
        }
        alignas(64) float low[3 * lanes], high[3 * lanes], bad[3 * lanes];
        const auto store = [&](std::size_t i, auto l, auto h, auto b) HWY_ATTR {
            hn::Store(l, df, low + i);
            hn::Store(h, df, high + i);
            hn::Store(b, df, bad + i);
        };
        store(0, low0, high0, bad0);
        store(lanes, low1, high1, bad1);
        store(2 * lanes, low2, high2, bad2);
        for (std::size_t i = 0; i < 3 * lanes; i += 6) {
            result.box.extend(Vec3<float>{low[i], low[i + 1], low[i + 2]});
            result.box.extend(Vec3<float>{high[i], high[i + 1], high[i + 2]});
            for (std::size_t axis = 0; axis < 3; ++axis)
                result.valid = result.valid && bad[i + axis] == 0;
        }
        // Without any full step these are still the empty box, (+inf, -inf) the wrong way round.
        if (done == 0)
            result = {};
    }
    for (; done < boxes.size(); ++done)
        AddCentre(boxes[done], result);
    return result;
}

using F = hn::Vec<decltype(df)>;
using U = hn::Vec<decltype(du)>;

/// One axis of one level: where the curve turns back or swaps axes below this level, the bits below
/// `q` of the first axis and this one do so.
HWY_INLINE void Turn(U q, U below, U& first, U& axis) {
    const auto set = hn::TestBit(axis, q);
    const U swapped = hn::And(hn::Xor(first, axis), below);
    first = hn::Xor(first, hn::IfThenElse(set, below, swapped));
    axis = hn::Xor(axis, hn::IfThenZeroElse(set, swapped));
}

/// Cells to the transposed Hilbert index.
template <int bits> HWY_INLINE void Hilbert(U& x, U& y, U& z) {
    for (int level = bits - 1; level > 0; --level) {
        const U q = hn::Set(du, 1u << level), below = hn::Set(du, (1u << level) - 1);
        x = hn::Xor(x, hn::IfThenElseZero(hn::TestBit(x, q), below));
        Turn(q, below, x, y);
        Turn(q, below, x, z);
    }
    y = hn::Xor(y, x);
    z = hn::Xor(z, y);
    // Each bit is the parity of the bits of z above it.
    U t = hn::ShiftRight<1>(z);
    t = hn::Xor(t, hn::ShiftRight<1>(t));
    t = hn::Xor(t, hn::ShiftRight<2>(t));
    t = hn::Xor(t, hn::ShiftRight<4>(t));
    t = hn::Xor(t, hn::ShiftRight<8>(t));
    if constexpr (bits > 16)
        t = hn::Xor(t, hn::ShiftRight<16>(t));
    x = hn::Xor(x, t);
    y = hn::Xor(y, t);
    z = hn::Xor(z, t);
}

/// Two zeros before each bit.
template <class D> HWY_INLINE hn::Vec<D> Spread(D d, hn::Vec<D> x) {
    using T = hn::TFromD<D>;
    const auto mask = [&](std::uint64_t m) HWY_ATTR { return hn::Set(d, static_cast<T>(m)); };
    if constexpr (sizeof(T) == 8) {
        x = hn::And(hn::Or(x, hn::ShiftLeft<32>(x)), mask(0x001f00000000ffff));
        x = hn::And(hn::Or(x, hn::ShiftLeft<16>(x)), mask(0x001f0000ff0000ff));
    } else {
        x = hn::And(hn::Or(x, hn::ShiftLeft<16>(x)), mask(0x030000ff));
    }
    x = hn::And(hn::Or(x, hn::ShiftLeft<8>(x)), mask(0x100f00f00f00f00f));
    x = hn::And(hn::Or(x, hn::ShiftLeft<4>(x)), mask(0x10c30c30c30c30c3));
    return hn::And(hn::Or(x, hn::ShiftLeft<2>(x)), mask(0x1249249249249249));
}

/// Codes of `bits` bits per axis, as keys of type Key.
template <class Key, int bits>
void CodesOf(Boxes boxes, Curve curve, const CurveGrid& grid, Key* HWY_RESTRICT codes) {
    constexpr std::size_t batch = 128;
    constexpr hn::ScalableTag<Key> dk;
    constexpr hn::Rebind<std::uint32_t, decltype(dk)> part;
    alignas(64) float x[batch], y[batch], z[batch];
    alignas(64) std::uint32_t cx[batch], cy[batch], cz[batch];
    alignas(64) Key last[batch];
    const float half = .5f * grid.power;
    const auto scale = hn::Set(df, grid.scale);
    const auto cells = [&](F at) HWY_ATTR {
        const auto cell = hn::ConvertTo(di, hn::Mul(hn::Max(at, hn::Zero(df)), scale));
        return hn::BitCast(du, hn::Min(cell, hn::Set(di, (1 << bits) - 1)));
    };
    for (std::size_t first = 0; first < boxes.size(); first += batch) {
        const std::size_t n = std::min(batch, boxes.size() - first);
        for (std::size_t i = 0; i < n; ++i) {
            const Box& box = boxes[first + i];
            x[i] = box.min.x * half + box.max.x * half - grid.low.x;
            y[i] = box.min.y * half + box.max.y * half - grid.low.y;
            z[i] = box.min.z * half + box.max.z * half - grid.low.z;
        }
        // Lanes beyond n hold whatever they held; their codes go nowhere.
        for (std::size_t i = n; i < batch && i % hn::Lanes(df) != 0; ++i)
            x[i] = y[i] = z[i] = 0;
        for (std::size_t i = 0; i < n; i += hn::Lanes(df)) {
            U a = cells(hn::Load(df, x + i)), b = cells(hn::Load(df, y + i)),
              c = cells(hn::Load(df, z + i));
            if (curve == Curve::hilbert)
                Hilbert<bits>(a, b, c);
            hn::Store(a, du, cx + i);
            hn::Store(b, du, cy + i);
            hn::Store(c, du, cz + i);
        }
        const auto load = [&](const std::uint32_t* from) HWY_ATTR {
            if constexpr (sizeof(Key) == 8)
                return Spread(dk, hn::PromoteTo(dk, hn::Load(part, from)));
            else
                return Spread(dk, hn::Load(part, from));
        };
        Key* const to = n == batch ? codes + first : last;
        for (std::size_t i = 0; i < n; i += hn::Lanes(dk))
            hn::StoreU(
                hn::Or(hn::Or(hn::ShiftLeft<2>(load(cx + i)), hn::ShiftLeft<1>(load(cy + i))),
                       load(cz + i)),
                dk, to + i);
        if (to == last)
            std::copy_n(last, n, codes + first);
    }
}

void FineCodes(Boxes boxes, Curve curve, const CurveGrid& grid, std::uint64_t* codes) {
    CodesOf<std::uint64_t, 21>(boxes, curve, grid, codes);
}
void CoarseCodes(Boxes boxes, Curve curve, const CurveGrid& grid, std::uint32_t* codes) {
    CodesOf<std::uint32_t, 10>(boxes, curve, grid, codes);
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(MeasureCentres);
HWY_EXPORT(FineCodes);
HWY_EXPORT(CoarseCodes);

namespace {

/// The cube around the centres, cut into 2^bits cells along each axis.
CurveGrid make_grid(Boxes boxes, int bits, const Executor& executor) {
    const std::size_t chunks = chunks_for(boxes.size(), executor);
    std::vector<CentreBounds> parts(chunks);
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(boxes.size(), chunks, c);
        parts[c] = HWY_DYNAMIC_DISPATCH(MeasureCentres)(
            boxes.subspan(range.begin, range.end - range.begin));
    });
    Box centres;
    bool valid = boxes.size() <= max_items;
    for (const CentreBounds& part : parts) {
        centres.extend(part.box);
        valid = valid && part.valid;
    }
    if (!valid)
        require_valid(boxes); // finds which
    const Vec3<double> extent = Vec3<double>(centres.max) - Vec3<double>(centres.min);
    const double side = std::max({extent.x, extent.y, extent.z});
    CurveGrid grid;
    if (!(side > 0))
        return grid;
    // A side below 2^-60 has all coordinates below 2^-36 (else the centres would be the same).
    grid.power = side > 0x1p100 ? 0x1p-30f : side < 0x1p-60 ? 0x1p80f : 1.f;
    grid.low = grid.power * centres.min;
    grid.scale = static_cast<float>(std::ldexp(1, bits) / (side * double{grid.power}));
    return grid;
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
/// runs of more than `alike` that agree in all bits.
template <class Less>
bool sort_records(Records& records, int bits, const Less& less, const Executor& executor,
                  std::size_t alike = 8) {
    const std::size_t n = records.size();
    Records spare(n);
    const int enough = (static_cast<int>(std::bit_width(n)) + 4 + 7) / 8 * 8;
    const int low = 32 + std::max(0, bits - enough);
    radix_sort(records, spare, low, 32 + bits, executor);
    const Runs runs(records, low, low == 32 ? alike : quickly_sorted, executor);
    if (runs.in_long <= few(n)) {
        runs.sort(records, less, executor);
        if (low == 32 || runs.items <= few(n))
            return true;
    } else {
        radix_sort(records, spare, 32, 32 + bits, executor);
    }
    const Runs rest(records, 32, alike, executor);
    if (rest.in_long > few(n))
        return false;
    rest.sort(records, less, executor);
    return true;
}

} // namespace

CurveOrder curve_order(Boxes boxes, Curve curve, const Executor& executor) {
    const std::size_t n = boxes.size();
    const CurveGrid grid = make_grid(boxes, 21, executor);
    Buffer<std::uint64_t> codes(n);
    Records records(n);
    constexpr int upper = 32, lower = 31; // bits of a code, sorted in two rounds if need be
    for_parts(n, executor, [&](std::size_t begin, std::size_t end) {
        HWY_DYNAMIC_DISPATCH(FineCodes)
        (boxes.subspan(begin, end - begin), curve, grid, codes.data() + begin);
        for (std::size_t i = begin; i < end; ++i)
            records[i] = codes[i] >> lower << 32 | i;
    });
    const auto less = [&](std::uint64_t a, std::uint64_t b) {
        const std::uint64_t code_a = codes[item_of(a)], code_b = codes[item_of(b)];
        return code_a < code_b || (code_a == code_b && item_of(a) < item_of(b));
    };
    if (!sort_records(records, upper, less, executor, quickly_sorted)) {
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

KeptOrder kept_curve_order(Boxes boxes, Curve curve, const Executor& executor) {
    const std::size_t n = boxes.size();
    KeptOrder kept{make_grid(boxes, 10, executor), Records(n)};
    for_parts(n, executor, [&](std::size_t begin, std::size_t end) {
        curve_records(boxes.subspan(begin, end - begin), begin, curve, kept.grid,
                      kept.records.data() + begin);
    });
    if (!sort_records(kept.records, 30, std::less<>(), executor))
        kept.records = {};
    return kept;
}

void curve_records(Boxes boxes, std::size_t first_item, Curve curve, const CurveGrid& grid,
                   std::uint64_t* records) {
    constexpr std::size_t batch = 1024;
    std::uint32_t codes[batch];
    for (std::size_t first = 0; first < boxes.size(); first += batch) {
        const std::size_t some = std::min(batch, boxes.size() - first);
        HWY_DYNAMIC_DISPATCH(CoarseCodes)(boxes.subspan(first, some), curve, grid, codes);
        for (std::size_t i = 0; i < some; ++i)
            records[first + i] = std::uint64_t{codes[i]} << 32 | (first_item + first + i);
    }
}

Buffer<std::uint32_t> coarse_curve_order(Boxes boxes, Curve curve, const Executor& executor) {
    const std::size_t n = boxes.size();
    const KeptOrder kept = kept_curve_order(boxes, curve, executor);
    if (kept.records.size() != n)
        return curve_order(boxes, curve, executor).order;
    Buffer<std::uint32_t> order(n);
    for_parts(n, executor, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            order[i] = item_of(kept.records[i]);
    });
    return order;
}

} // namespace boxwood
#endif
