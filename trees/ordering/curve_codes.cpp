// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/ordering/curve_codes.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/ordering/curve_codes.h"

#include <algorithm>
#include <array>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::ScalableTag<float> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;

inline void add_centre(const Box& box, CentreBounds& to) {
    to.box.extend(.5f * box.min + .5f * box.max);
    to.valid = to.valid && box.is_valid();
}

/// The boxes are read as a row of floats. In three registers every place has
/// the same coordinate each time (registers hold 4, 8 or 16 floats, a box 6),
/// so no lane ever changes place; those that would add a box's max to the next
/// box's min are left out at the end.
CentreBounds measure_centres(Boxes boxes) {
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
        // Without any full step these are still the empty box, (+inf, -inf) the
        // wrong way round.
        if (done == 0)
            result = {};
    }
    for (; done < boxes.size(); ++done)
        add_centre(boxes[done], result);
    return result;
}

using F = hn::Vec<decltype(df)>;
using U = hn::Vec<decltype(du)>;

/// One axis of one level: where the curve turns back or swaps axes below this
/// level, the bits below `q` of the first axis and this one do so.
template <class V> HWY_INLINE void turn(V q, V below, V& first, V& axis) {
    const auto set = hn::TestBit(axis, q);
    const V swapped = hn::And(hn::Xor(first, axis), below);
    first = hn::Xor(first, hn::IfThenElse(set, below, swapped));
    axis = hn::Xor(axis, hn::IfThenZeroElse(set, swapped));
}

/// Cells to the transposed Hilbert index.
template <int bits, class D>
HWY_INLINE void hilbert_index(D d, hn::Vec<D>& x, hn::Vec<D>& y, hn::Vec<D>& z) {
    using T = hn::TFromD<D>;
    for (int level = bits - 1; level > 0; --level) {
        const auto q = hn::Set(d, static_cast<T>(1u << level)),
                   below = hn::Set(d, static_cast<T>((1u << level) - 1));
        x = hn::Xor(x, hn::IfThenElseZero(hn::TestBit(x, q), below));
        turn(q, below, x, y);
        turn(q, below, x, z);
    }
    y = hn::Xor(y, x);
    z = hn::Xor(z, y);
    // Each bit is the parity of the bits of z above it.
    auto t = hn::ShiftRight<1>(z);
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

/// Two zeros before each of 21 bits.
template <class D> HWY_INLINE hn::Vec<D> spread(D d, hn::Vec<D> x) {
    const auto mask = [&](std::uint64_t m) HWY_ATTR { return hn::Set(d, m); };
    x = hn::And(hn::Or(x, hn::ShiftLeft<32>(x)), mask(0x001f00000000ffff));
    x = hn::And(hn::Or(x, hn::ShiftLeft<16>(x)), mask(0x001f0000ff0000ff));
    x = hn::And(hn::Or(x, hn::ShiftLeft<8>(x)), mask(0x100f00f00f00f00f));
    x = hn::And(hn::Or(x, hn::ShiftLeft<4>(x)), mask(0x10c30c30c30c30c3));
    return hn::And(hn::Or(x, hn::ShiftLeft<2>(x)), mask(0x1249249249249249));
}

void fine_codes(Boxes boxes, Curve curve, const CurveGrid& grid,
                std::uint64_t* HWY_RESTRICT codes) {
    constexpr std::size_t batch = 128;
    constexpr int bits = 21;
    constexpr hn::ScalableTag<std::uint64_t> dk;
    constexpr hn::Rebind<std::uint32_t, decltype(dk)> part;
    alignas(64) float x[batch], y[batch], z[batch];
    alignas(64) std::uint32_t cx[batch], cy[batch], cz[batch];
    alignas(64) std::uint64_t last[batch];
    const float half = .5f * grid.power;
    const auto scale = hn::Set(df, grid.scale);
    const auto cells = [&](const float* at) HWY_ATTR {
        const auto cell =
            hn::ConvertTo(di, hn::Mul(hn::Max(hn::Load(df, at), hn::Zero(df)), scale));
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
            U a = cells(x + i), b = cells(y + i), c = cells(z + i);
            if (curve == Curve::hilbert)
                hilbert_index<bits>(du, a, b, c);
            hn::Store(a, du, cx + i);
            hn::Store(b, du, cy + i);
            hn::Store(c, du, cz + i);
        }
        const auto load = [&](const std::uint32_t* from) HWY_ATTR {
            return spread(dk, hn::PromoteTo(dk, hn::Load(part, from)));
        };
        std::uint64_t* const to = n == batch ? codes + first : last;
        for (std::size_t i = 0; i < n; i += hn::Lanes(dk))
            hn::StoreU(
                hn::Or(hn::Or(hn::ShiftLeft<2>(load(cx + i)), hn::ShiftLeft<1>(load(cy + i))),
                       load(cz + i)),
                dk, to + i);
        if (to == last)
            std::copy_n(last, n, codes + first);
    }
}

/// Three bits of the code for each of `levels` levels, from the top bits of the
/// cells downwards. The same curve as hilbert_index() follows, by what is below the
/// current level: it turns back (all bits flip) or two axes swap. `flip` takes
/// from level to level which digits are to be flipped; at first it is 0.
template <class D>
HWY_INLINE hn::Vec<D> digits(D d, Curve curve, int levels, hn::Vec<D>& x, hn::Vec<D>& y,
                             hn::Vec<D>& z, hn::Vec<D>& flip) {
    using T = hn::TFromD<D>;
    using V = hn::Vec<D>;
    constexpr hn::RebindToSigned<D> ds;
    const auto top = [&](V v) HWY_ATTR {
        return hn::BitCast(d, hn::BroadcastSignBit(hn::BitCast(ds, v)));
    };
    V code = hn::Zero(d);
    const auto put = [&](V bits, unsigned place) HWY_ATTR {
        code = hn::Or(code, hn::And(bits, hn::Set(d, static_cast<T>(place))));
    };
#pragma GCC unroll 5
    for (int level = 0; level < levels; ++level) {
        const V at_x = top(x), at_y = top(y), at_z = top(z);
        code = hn::ShiftLeft<3>(code);
        if (curve == Curve::hilbert) {
            const V first = hn::Xor(flip, at_x), second = hn::Xor(first, at_y);
            flip = hn::Xor(second, at_z);
            put(first, 4);
            put(second, 2);
            put(flip, 1);
            const V a = hn::Xor(x, at_x);
            const V b = hn::IfVecThenElse(at_y, hn::Not(a), y);
            y = hn::IfVecThenElse(at_y, y, a);
            x = hn::IfVecThenElse(at_z, hn::Not(b), z);
            z = hn::IfVecThenElse(at_z, z, b);
        } else {
            put(at_x, 4);
            put(at_y, 2);
            put(at_z, 1);
        }
        x = hn::Add(x, x);
        y = hn::Add(y, y);
        z = hn::Add(z, z);
    }
    return code;
}

/// Ten bits of cells and, below these, what lies within a cell: bits 22 and lower; anything above.
HWY_INLINE U fine_cells(F at, F scale) {
    // Numbers from 1024 to below 2048 have these bits as their mantissa.
    constexpr float zero = 1024, max_cell = 2047.5f;
    const F moved = hn::Add(hn::Mul(at, scale), hn::Set(df, zero));
    return hn::BitCast(du, hn::Min(hn::Max(moved, hn::Set(df, zero)), hn::Set(df, max_cell)));
}

#if HWY_TARGET == HWY_SCALAR
void coarse_codes(Boxes boxes, Curve curve, const CurveGrid& grid,
                  std::uint32_t* HWY_RESTRICT codes) {
    const float half = .5f * grid.power;
    const auto scale = hn::Set(df, grid.scale);
    const auto cells = [&](float min, float max, float low) {
        return hn::ShiftLeft<9>(fine_cells(hn::Set(df, min * half + max * half - low), scale));
    };
    for (const Box& box : boxes) {
        U x = cells(box.min.x, box.max.x, grid.low.x), y = cells(box.min.y, box.max.y, grid.low.y),
          z = cells(box.min.z, box.max.z, grid.low.z), flip = hn::Zero(du);
        *codes++ = hn::GetLane(digits(du, curve, 10, x, y, z, flip));
    }
}
#else
constexpr std::size_t lanes = HWY_MAX_BYTES / sizeof(float);

/// Of `lanes` / 2 boxes that lie in three registers as a row of floats: which
/// register has an x (or a y: the place after) or a z at each place. Registers
/// hold an even number of floats and a box six, so no two boxes have theirs at
/// the same place, and x and z are at even ones.
struct RowPlaces {
    alignas(64) std::int32_t of_xy[lanes] = {}, of_z[lanes] = {};
    /// Once the even places of two rows stand side by side: where to find the z
    /// to each x, and where each box is.
    alignas(64) std::int32_t z_to_x[lanes] = {}, box[lanes] = {};

    constexpr RowPlaces() {
        constexpr std::size_t half = lanes / 2;
        for (std::size_t k = 0; k < half; ++k) {
            of_xy[6 * k % lanes] = of_xy[(6 * k + 1) % lanes] = static_cast<int>(6 * k / lanes);
            of_z[(6 * k + 2) % lanes] = static_cast<int>((6 * k + 2) / lanes);
            for (const std::size_t row : {std::size_t{0}, half}) {
                z_to_x[row + k] = static_cast<int>(row + (k + 1) % half);
                box[row + k] = static_cast<int>(row + 6 * k % lanes / 2);
            }
        }
    }
};
constexpr RowPlaces places;

/// Cells of `lanes` boxes, in the order of RowPlaces; reads three floats beyond
/// them.
HWY_INLINE void cells_of(const float* HWY_RESTRICT row, F half, F scale, F low_xy, F low_z, U& x,
                         U& y, U& z) {
    const auto from = [&](const std::int32_t* which, int i) HWY_ATTR {
        return hn::RebindMask(df, hn::Eq(hn::Load(di, which), hn::Set(di, i)));
    };
    const auto xy1 = from(places.of_xy, 1), xy2 = from(places.of_xy, 2), z1 = from(places.of_z, 1),
               z2 = from(places.of_z, 2);
    F xy[2], zs[2];
    for (std::size_t i = 0; i < 2; ++i) {
        const auto centre = [&](std::size_t at) HWY_ATTR {
            const float* const p = row + (3 * i + at) * lanes;
            return hn::Add(hn::Mul(hn::LoadU(df, p), half), hn::Mul(hn::LoadU(df, p + 3), half));
        };
        const F r0 = centre(0), r1 = centre(1), r2 = centre(2);
        xy[i] = hn::Sub(hn::IfThenElse(xy2, r2, hn::IfThenElse(xy1, r1, r0)), low_xy);
        zs[i] = hn::Sub(hn::IfThenElse(z2, r2, hn::IfThenElse(z1, r1, r0)), low_z);
    }
    x = fine_cells(hn::ConcatEven(df, xy[1], xy[0]), scale);
    y = fine_cells(hn::ConcatOdd(df, xy[1], xy[0]), scale);
    z = hn::TableLookupLanes(fine_cells(hn::ConcatEven(df, zs[1], zs[0]), scale),
                             hn::SetTableIndices(du, places.z_to_x));
}

/// Codes of 2 `lanes` boxes at a time. Ten bits fit in half a lane: the second
/// `lanes` boxes have the upper halves.
void coarse_codes(Boxes boxes, Curve curve, const CurveGrid& grid,
                  std::uint32_t* HWY_RESTRICT codes) {
    constexpr hn::Repartition<std::uint16_t, decltype(du)> dh;
    constexpr std::size_t step = 2 * lanes;
    const auto half = hn::Set(df, .5f * grid.power), scale = hn::Set(df, grid.scale);
    const auto low_xy = hn::OddEven(hn::Set(df, grid.low.y), hn::Set(df, grid.low.x)),
               low_z = hn::Set(df, grid.low.z);
    const auto in_order = hn::SetTableIndices(du, places.box);
    const auto lower = hn::Set(du, 0xffffu);
    const auto some = [&](const Box* from, std::uint32_t* to) HWY_ATTR {
        U x[2], y[2], z[2];
        for (std::size_t i = 0; i < 2; ++i)
            cells_of(reinterpret_cast<const float*>(from + i * lanes), half, scale, low_xy, low_z,
                     x[i], y[i], z[i]);
        const auto both = [&](const U* c) HWY_ATTR {
            return hn::BitCast(
                dh, hn::IfVecThenElse(lower, hn::ShiftRight<7>(c[0]), hn::ShiftLeft<9>(c[1])));
        };
        auto a = both(x), b = both(y), c = both(z), flip = hn::Zero(dh);
        const U high = hn::BitCast(du, digits(dh, curve, 5, a, b, c, flip));
        const U low = hn::BitCast(du, digits(dh, curve, 5, a, b, c, flip));
        const auto put = [&](U upper, U below, std::uint32_t* at) HWY_ATTR {
            const U code = hn::Or(hn::ShiftLeft<15>(upper), below);
            hn::StoreU(hn::TableLookupLanes(code, in_order), du, at);
        };
        put(hn::And(high, lower), hn::And(low, lower), to);
        put(hn::ShiftRight<16>(high), hn::ShiftRight<16>(low), to + lanes);
    };
    std::size_t done = 0;
    for (; done + step < boxes.size(); done += step)
        some(boxes.data() + done, codes + done);
    while (done < boxes.size()) {
        const std::size_t rest = std::min(step, boxes.size() - done);
        std::array<Box, step + 1> last;
        last.fill(boxes[done]);
        std::copy_n(boxes.data() + done, rest, last.data());
        std::array<std::uint32_t, step> codes_of_last;
        some(last.data(), codes_of_last.data());
        std::copy_n(codes_of_last.data(), rest, codes + done);
        done += rest;
    }
}
#endif

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(measure_centres);
HWY_EXPORT(fine_codes);
HWY_EXPORT(coarse_codes);
} // namespace boxwood::detail

namespace boxwood {
using namespace detail;

CentreBounds measure_centres(Boxes boxes) { return HWY_DYNAMIC_DISPATCH(measure_centres)(boxes); }
void fine_codes(Boxes boxes, Curve curve, const CurveGrid& grid, std::uint64_t* codes) {
    HWY_DYNAMIC_DISPATCH(fine_codes)(boxes, curve, grid, codes);
}
void coarse_codes(Boxes boxes, Curve curve, const CurveGrid& grid, std::uint32_t* codes) {
    HWY_DYNAMIC_DISPATCH(coarse_codes)(boxes, curve, grid, codes);
}

} // namespace boxwood
#endif
