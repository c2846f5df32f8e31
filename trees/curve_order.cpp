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
#include <limits>
#include <utility>
#include <vector>

#ifndef BOXWOOD_CURVE_GRID
#define BOXWOOD_CURVE_GRID
namespace boxwood {

/// The cube around the centres and its cells.
struct CurveGrid {
    Vec3<float> low; ///< of the cube, times `power`
    float power = 1; ///< of two: takes huge and tiny coordinates to where nothing overflows
    float scale = 0; ///< from there to cells
};

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

struct FineRecord {
    std::uint64_t code;
    std::uint32_t item;

    static constexpr int bits = 63, digit = 11;
    using Code = std::uint64_t;
    FineRecord(Code code_, std::uint32_t item_) : code(code_), item(item_) {}
    FineRecord() = default;
    Code key() const { return code; }
    auto operator<=>(const FineRecord&) const = default;
};

/// Code and item in eight bytes.
struct CoarseRecord {
    std::uint64_t both;

    static constexpr int bits = 30, digit = 10;
    using Code = std::uint32_t;
    CoarseRecord(Code code, std::uint32_t item_) : both(std::uint64_t{code} << 32 | item_) {}
    CoarseRecord() = default;
    Code key() const { return static_cast<Code>(both >> 32); }
    auto operator<=>(const CoarseRecord&) const = default;
};

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

void codes_of(Boxes boxes, Curve curve, const CurveGrid& grid, std::uint64_t* codes) {
    HWY_DYNAMIC_DISPATCH(FineCodes)(boxes, curve, grid, codes);
}
void codes_of(Boxes boxes, Curve curve, const CurveGrid& grid, std::uint32_t* codes) {
    HWY_DYNAMIC_DISPATCH(CoarseCodes)(boxes, curve, grid, codes);
}

template <class Record>
Buffer<Record> records_of(Boxes boxes, Curve curve, const Executor& executor) {
    const std::size_t n = boxes.size(), chunks = chunks_for(n, executor);
    const CurveGrid grid = make_grid(boxes, Record::bits / 3, executor);
    Buffer<Record> records(n);
    executor.for_each(chunks, [&](std::size_t c) {
        constexpr std::size_t batch = 1024;
        typename Record::Code codes[batch];
        const ChunkRange range(n, chunks, c);
        for (std::size_t first = range.begin; first < range.end; first += batch) {
            const std::size_t some = std::min(batch, range.end - first);
            codes_of(boxes.subspan(first, some), curve, grid, codes);
            for (std::size_t i = 0; i < some; ++i)
                records[first + i] = Record(codes[i], static_cast<std::uint32_t>(first + i));
        }
    });
    return records;
}

/// Items in runs of equal digits that may be sorted, or left, one run at a time.
std::size_t few(std::size_t n) { return n / 8; }

/// Calls f(begin, end) for each run of two or more records with the same key above `low`, each in
/// the chunk that it begins in.
template <class Record, class F>
void for_runs(const Buffer<Record>& records, int low, ChunkRange range, const F& f) {
    const std::size_t n = records.size();
    const auto same = [&](std::size_t i, std::size_t j) {
        return records[i].key() >> low == records[j].key() >> low;
    };
    std::size_t i = range.begin;
    while (i > 0 && i < range.end && same(i - 1, i))
        ++i;
    while (i < range.end) {
        std::size_t end = i + 1;
        while (end < n && same(i, end))
            ++end;
        if (end > i + 1)
            f(i, end);
        i = end;
    }
}

/// By key and then by item; the records come with their items ascending. Sorts by as many leading
/// digits as tell most items apart if they are spread out, then the few runs that still have the
/// same; if those are many, by all digits. Returns how many items had the same leading digits as
/// another.
template <class Record>
std::size_t sort_records(Buffer<Record>& records, const Executor& executor) {
    constexpr int digit = Record::digit, all = (Record::bits + digit - 1) / digit;
    const std::size_t n = records.size(), chunks = chunks_for(n, executor);
    Buffer<Record> spare(n);
    const int wanted = static_cast<int>(std::bit_width(n)) + 8;
    const int passes = std::min(all, (wanted + digit - 1) / digit);
    const int low = std::max(0, Record::bits - passes * digit);
    radix_sort<Record, digit>(records, spare, low, Record::bits, executor);
    using Run = std::pair<std::size_t, std::size_t>;
    std::vector<std::vector<Run>> runs(chunks);
    executor.for_each(chunks, [&](std::size_t c) {
        for_runs(records, low, ChunkRange(n, chunks, c),
                 [&](std::size_t begin, std::size_t end) { runs[c].emplace_back(begin, end); });
    });
    std::size_t in_runs = 0;
    for (const std::vector<Run>& part : runs)
        for (const Run& run : part)
            in_runs += run.second - run.first;
    if (low == 0)
        return in_runs; // stable: equal codes still have their items ascending
    if (in_runs > few(n))
        radix_sort<Record, digit>(records, spare, 0, Record::bits, executor);
    else
        executor.for_each(chunks, [&](std::size_t c) {
            for (const Run& run : runs[c])
                std::sort(records.begin() + run.first, records.begin() + run.second);
        });
    return in_runs;
}

} // namespace

CurveOrder curve_order(Boxes boxes, Curve curve, const Executor& executor) {
    Buffer<FineRecord> records = records_of<FineRecord>(boxes, curve, executor);
    sort_records(records, executor);
    const std::size_t n = boxes.size(), chunks = chunks_for(n, executor);
    CurveOrder result{Buffer<std::uint64_t>(n), Buffer<std::uint32_t>(n)};
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(n, chunks, c);
        for (std::size_t i = range.begin; i < range.end; ++i) {
            result.codes[i] = records[i].code;
            result.order[i] = records[i].item;
        }
    });
    return result;
}

Buffer<std::uint32_t> coarse_curve_order(Boxes boxes, Curve curve, const Executor& executor) {
    Buffer<CoarseRecord> records = records_of<CoarseRecord>(boxes, curve, executor);
    if (sort_records(records, executor) > few(boxes.size()))
        return curve_order(boxes, curve, executor).order;
    const std::size_t n = boxes.size(), chunks = chunks_for(n, executor);
    Buffer<std::uint32_t> order(n);
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(n, chunks, c);
        for (std::size_t i = range.begin; i < range.end; ++i)
            order[i] = static_cast<std::uint32_t>(records[i].both);
    });
    return order;
}

} // namespace boxwood
#endif
