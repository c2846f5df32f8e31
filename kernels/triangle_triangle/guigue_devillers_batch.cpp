// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/triangle_triangle/guigue_devillers_batch.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "kernels/arithmetic/float_mode.h"
#include "kernels/simd/vec3-inl.h"
#include "kernels/triangle_triangle/guigue_devillers_batch.h"

#include <algorithm>
#include <bit>
#include <cstring>

#ifndef BOXWOOD_GUIGUE_DEVILLERS_BATCH_ONCE
#define BOXWOOD_GUIGUE_DEVILLERS_BATCH_ONCE
namespace boxwood {
namespace {

using PassUp = Decision (*)(const void* block, std::size_t lane, int tier);

/// A lane's pair by the kernel above, whose tiers are counted from `tier`. Denormal floats would be
/// lost if they were flushed on the way.
template <class Real, class Up> Decision pass_up(const void* block, std::size_t lane, int tier) {
    return without_flushing([&] {
        const auto& pairs = *static_cast<const TrianglePairBlock<Real>*>(block);
        const auto as_read = [](const Triangle<Real>& t) {
            using To = Vec3<typename Up::Real>;
            return Triangle<typename Up::Real>{To(t.a), To(t.b), To(t.c)};
        };
        const Decision above =
            Up::intersect(as_read(pairs.triangle(0, lane)), as_read(pairs.triangle(1, lane)));
        return Decision{above.answer, static_cast<std::uint8_t>(above.tier + tier)};
    });
}

// When a sign is certain. All corners are seen from a's first one; m is the largest |coordinate|
// of them per axis, but at least `min_size`. A triple product of such corners has passed 8
// roundings (3 differences, product, minor, product, two sums) in each of 6 products of at most mx
// my mz. Every quantity below is the sum of at most 4 triple products, by at most 3 more sums: it's
// off by less than 4 * 6 * 11u mx my mz = 264u mx my mz. 270u leaves room for the terms in u^2, for
// the roundings of m and of the bound, and for underflow, in any mode of flushing: with f = 2^-1022
// or 2^-126 it costs a coordinate 3 f (operands and result), a minor 3 f and a product f, which is
// less than u/1000 of m, of mx my and of mx my mz, given `min_size`.
// The bound is computed `headroom` times as large: if that is finite, nothing has overflown, since
// mx my mz < 2^670 and thus mx my < 2^970, or 2^96 and 2^124. Infinite, it makes nothing certain.
template <class Real> struct CertainSign;
template <> struct CertainSign<double> {
    static constexpr double min_size = 0x1p-300, bound = 270 * 0x1p-53, headroom = 0x1p400;
};
template <> struct CertainSign<float> {
    static constexpr float min_size = 0x1p-28f, bound = 270 * 0x1p-24f, headroom = 0x1p48f;
};

static_assert(sizeof(Decision) == sizeof(std::uint16_t) &&
              std::bit_cast<std::uint16_t>(Decision{}) == 0);

} // namespace
} // namespace boxwood
#endif

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class V> HWY_INLINE V largest_size(V min_size, V a, V b, V c, V d, V e) {
    const V ab = hn::Max(hn::Abs(a), hn::Abs(b)), cd = hn::Max(hn::Abs(c), hn::Abs(d));
    return hn::Max(hn::Max(ab, cd), hn::Max(hn::Abs(e), min_size));
}

/// Where the sign bit is set.
template <class D> HWY_INLINE hn::Mask<D> negative(D d, hn::Vec<D> v) {
    const hn::RebindToSigned<D> di;
    return hn::RebindMask(d, hn::Lt(hn::BitCast(di, v), hn::Zero(di)));
}

template <class D> HWY_INLINE std::uint32_t mask_bits(D d, hn::Mask<D> mask) {
    std::uint8_t part[8] = {};
    hn::StoreMaskBits(d, mask, part);
    return part[0] | std::uint32_t{part[1]} << 8;
}

/// Which corner of a triangle the other's plane parts from the two others, from its three heights
/// above that plane, all of them certain. Sign bits: `differ01` is set where the heights of corners
/// 0 and 1 differ, and so on; `below` where the lone corner's height is negative.
template <class D> struct Lone {
    hn::Vec<D> differ01, differ02, differ12, below;
    hn::Mask<D> not1, not2;

    HWY_INLINE Lone(D d, hn::Vec<D> h0, hn::Vec<D> h1, hn::Vec<D> h2)
        : differ01(hn::Xor(h0, h1)), differ02(hn::Xor(h0, h2)), differ12(hn::Xor(h1, h2)),
          below(hn::Xor(differ01, h2)), not1(negative(d, differ02)), not2(negative(d, differ01)) {}

    /// Whether there is one: the plane passes between the corners.
    HWY_INLINE hn::Mask<D> exists() const { return hn::Or(not1, not2); }
    /// The value for the lone corner.
    HWY_INLINE hn::Vec<D> pick(hn::Vec<D> v0, hn::Vec<D> v1, hn::Vec<D> v2) const {
        return hn::IfThenElse(not2, hn::IfThenElse(not1, v0, v1), v2);
    }
    /// Of the edge from the lone corner to the next one (01, 12 or 20) and that to the last (02, 10
    /// or 21), values that are given for 01, 02 and 12. `turned`: the sign bit where it's reversed.
    HWY_INLINE hn::Vec<D> next(hn::Vec<D> v01, hn::Vec<D> v02, hn::Vec<D> v12) const {
        return pick(v01, v12, v02);
    }
    HWY_INLINE hn::Vec<D> last(hn::Vec<D> v01, hn::Vec<D> v02, hn::Vec<D> v12) const {
        return pick(v02, v01, v12);
    }
    HWY_INLINE hn::Vec<D> next_turned() const { return hn::Neg(differ01); }
    HWY_INLINE hn::Vec<D> last_turned() const { return differ12; }
};

/// The corners of both triangles as seen from a's first one.
template <class D> struct Seen { LaneVec3<hn::Vec<D>> a1, a2, b0, b1, b2; };

/// Lanes [i, i + Lanes(d)) of a block.
template <class D, class Real>
HWY_INLINE Seen<D> seen_lanes(D d, const TrianglePairBlock<Real>& block, std::size_t i) {
    const auto& [a, b] = block.corner;
    const auto origin = load3(d, a[0], i);
    return {load3(d, a[1], i) - origin, load3(d, a[2], i) - origin, load3(d, b[0], i) - origin,
            load3(d, b[1], i) - origin, load3(d, b[2], i) - origin};
}

template <class D> struct Decided {
    hn::Mask<D> yes, decided; ///< yes: within decided
};

template <bool proven, class D> HWY_INLINE Decided<D> decide(D d, const Seen<D>& seen) {
    using V = hn::Vec<D>;
    using Real = hn::TFromD<D>;
    const auto& [a1, a2, b0, b1, b2] = seen;
    // Heights of b's corners above a's plane, times its normal.
    const LaneVec3<V> normal = cross(a1, a2);
    const V above_a0 = dot(normal, b0), above_a1 = dot(normal, b1), above_a2 = dot(normal, b2);
    // The sides on which the lines of edges pass each other, e . moment(f) + f . moment(e): s01_02
    // is a's edge 01 and b's edge 02. The moments of a's edges are 0, 0 and `normal`; the last
    // three sides have f . normal for differences of heights.
    const LaneVec3<V> moment01 = cross(b0, b1), moment02 = cross(b0, b2), moment12 = cross(b1, b2);
    const V s01_01 = dot(a1, moment01), s01_02 = dot(a1, moment02), s01_12 = dot(a1, moment12);
    const V s02_01 = dot(a2, moment01), s02_02 = dot(a2, moment02), s02_12 = dot(a2, moment12);
    const V s12_01 = hn::Add(hn::Sub(s02_01, s01_01), hn::Sub(above_a1, above_a0));
    const V s12_02 = hn::Add(hn::Sub(s02_02, s01_02), hn::Sub(above_a2, above_a0));
    const V s12_12 = hn::Add(hn::Sub(s02_12, s01_12), hn::Sub(above_a2, above_a1));
    // b's normal is moment01 + moment12 - moment02.
    const V above_b0 = hn::Neg(dot(b0, moment12));
    const V above_b1 = hn::Add(hn::Sub(hn::Add(s01_01, s01_12), s01_02), above_b0);
    const V above_b2 = hn::Add(hn::Sub(hn::Add(s02_01, s02_12), s02_02), above_b0);

    V bound;
    if constexpr (proven) {
        using Certain = CertainSign<Real>;
        const V min_size = hn::Set(d, Certain::min_size);
        const V mx = largest_size(min_size, a1.x, a2.x, b0.x, b1.x, b2.x);
        const V my = largest_size(min_size, a1.y, a2.y, b0.y, b1.y, b2.y);
        const V mz = largest_size(min_size, a1.z, a2.z, b0.z, b1.z, b2.z);
        const V large =
            hn::Mul(hn::Mul(mx, my), hn::Mul(mz, hn::Set(d, Certain::bound * Certain::headroom)));
        bound = hn::Mul(large, hn::Set(d, 1 / Certain::headroom));
    } else {
        // Each coordinate has a part in one of the two: not certain if any is infinite or NaN.
        const V all = hn::Add(above_a0, above_b1);
        bound = hn::Abs(hn::Sub(all, all));
    }
    const auto certain = [&](V v) HWY_ATTR { return hn::Gt(hn::Abs(v), bound); };

    const Lone<D> a(d, above_b0, above_b1, above_b2), b(d, above_a0, above_a1, above_a2);
    // Each coordinate has a part in each of these two: no NaN is certain.
    const auto certain_a =
        hn::And(certain(above_b0), hn::And(certain(above_b1), certain(above_b2)));
    const auto certain_b =
        hn::And(certain(above_a0), hn::And(certain(above_a1), certain(above_a2)));
    const auto one_side =
        hn::Or(hn::AndNot(a.exists(), certain_a), hn::AndNot(b.exists(), certain_b));
    const auto crossing = hn::And(hn::And(a.exists(), certain_a), hn::And(b.exists(), certain_b));

    // The common line leaves each triangle through its lone corner's two edges. Turned so that the
    // lone corners are above the planes, the intervals overlap iff each one's first edge passes the
    // other's first, and last the last, on the right side. Turning one triangle swaps its edges.
    const auto swapped = negative(d, hn::Xor(a.below, b.below));
    const V next01 = b.next(s01_01, s01_02, s01_12), last01 = b.last(s01_01, s01_02, s01_12);
    const V next02 = b.next(s02_01, s02_02, s02_12), last02 = b.last(s02_01, s02_02, s02_12);
    const V next12 = b.next(s12_01, s12_02, s12_12), last12 = b.last(s12_01, s12_02, s12_12);
    const V first =
        hn::IfThenElse(swapped, a.last(next01, next02, next12), a.next(next01, next02, next12));
    const V second =
        hn::IfThenElse(swapped, a.next(last01, last02, last12), a.last(last01, last02, last12));
    const V first_turned = hn::IfThenElse(swapped, a.last_turned(), a.next_turned());
    const V second_turned = hn::IfThenElse(swapped, a.next_turned(), a.last_turned());
    const V right1 = hn::Xor(hn::Xor(first, a.below), hn::Xor(first_turned, b.next_turned()));
    const V wrong2 = hn::Xor(hn::Xor(second, a.below), hn::Xor(second_turned, b.last_turned()));
    const auto overlap = negative(d, hn::AndNot(wrong2, right1));

    const auto compared = hn::And(crossing, hn::And(certain(first), certain(second)));
    return {hn::And(compared, overlap), hn::Or(one_side, compared)};
}

/// Lanes [0, n) by way of see(i), the lanes [i, i + Lanes(d)): writes the decisions of all, returns
/// those that are not decided as bits.
template <bool proven, class D, class See>
HWY_INLINE std::uint32_t decide_lanes(D d, std::size_t n, Decision* decisions, const See& see) {
    const hn::RebindToUnsigned<D> du;
    const hn::Rebind<std::uint16_t, D> d16;
    constexpr auto yes = std::bit_cast<std::uint16_t>(Decision{Answer::yes, 0});
    std::uint32_t undecided_lanes = 0;
    for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
        const Decided<D> judgement = decide<proven>(d, see(i));
        std::uint16_t words[hn::MaxLanes(d)];
        const auto yes_lanes = hn::RebindMask(du, judgement.yes);
        hn::StoreU(hn::TruncateTo(d16, hn::IfThenElseZero(yes_lanes, hn::Set(du, yes))), d16,
                   words);
        std::memcpy(decisions + i, words, sizeof words);
        if (!hn::AllTrue(d, judgement.decided))
            undecided_lanes |= mask_bits(d, hn::Not(judgement.decided)) << i;
    }
    return undecided_lanes;
}

/// f(lane) for each bit.
template <class F> HWY_INLINE void for_each_lane(std::uint32_t bits, const F& f) {
    for (; bits != 0; bits &= bits - 1)
        f(static_cast<std::size_t>(std::countr_zero(bits)));
}

/// Sixteen decisions on their way to n <= 16 places.
class Sixteen {
  public:
    HWY_INLINE Sixteen(Decision* to, std::size_t n) : to_(to), n_(std::min<std::size_t>(n, 16)) {}
    HWY_INLINE ~Sixteen() {
        if (n_ < 16)
            std::copy_n(spare_, n_, to_);
    }
    HWY_INLINE Decision* data() { return n_ < 16 ? spare_ : to_; }
    HWY_INLINE std::uint32_t among(std::uint32_t bits) const { return bits & ((1u << n_) - 1); }

  private:
    Decision* to_;
    std::size_t n_;
    Decision spare_[16];
};

template <bool proven>
HWY_INLINE void decide_floats(std::span<const TrianglePairBlock<float>> blocks,
                              std::span<Decision> decisions, PassUp up) {
    const hn::CappedTag<float, 16> d;
    for (std::size_t k = 0; k < decisions.size(); k += 16) {
        const TrianglePairBlock<float>& block = blocks[k / 16];
        Sixteen said(&decisions[k], decisions.size() - k);
        const auto see = [&](std::size_t i) HWY_ATTR { return seen_lanes(d, block, i); };
        const std::uint32_t unsure = decide_lanes<proven>(d, 16, said.data(), see);
        for_each_lane(said.among(unsure),
                      [&](std::size_t lane) { said.data()[lane] = up(&block, lane, 1); });
    }
}

void float_pairs(std::span<const TrianglePairBlock<float>> blocks, std::span<Decision> decisions,
                 PassUp up) {
    decide_floats<false>(blocks, decisions, up);
}
void proven_float_pairs(std::span<const TrianglePairBlock<float>> blocks,
                        std::span<Decision> decisions, PassUp up) {
    decide_floats<true>(blocks, decisions, up);
}

/// Sixteen pairs of doubles, rounded to floats after their difference to a's first corner: the
/// bound of floats holds.
struct alignas(64) RoundedPairs {
    float corner[5][3][16];

    HWY_INLINE void round(const TrianglePairBlock<double>& block, std::size_t at) {
        const hn::CappedTag<double, 8> d;
        for (std::size_t i = 0; i < 8; i += hn::Lanes(d)) {
            const auto seen = seen_lanes(d, block, i);
            put(d, 0, at + i, seen.a1);
            put(d, 1, at + i, seen.a2);
            put(d, 2, at + i, seen.b0);
            put(d, 3, at + i, seen.b1);
            put(d, 4, at + i, seen.b2);
        }
    }
    template <class D> HWY_INLINE Seen<D> see(D d, std::size_t i) const {
        return {load3(d, corner[0], i), load3(d, corner[1], i), load3(d, corner[2], i),
                load3(d, corner[3], i), load3(d, corner[4], i)};
    }

  private:
    template <class D>
    HWY_INLINE void put(D, int k, std::size_t at, const LaneVec3<hn::Vec<D>>& v) {
        const hn::Rebind<float, D> df;
        hn::StoreU(hn::DemoteTo(df, v.x), df, corner[k][0] + at);
        hn::StoreU(hn::DemoteTo(df, v.y), df, corner[k][1] + at);
        hn::StoreU(hn::DemoteTo(df, v.z), df, corner[k][2] + at);
    }
};

/// Lanes that the floats leave open: by their doubles, then by the kernel above.
HWY_NOINLINE void reconsider(const TrianglePairBlock<double>& block, std::uint32_t lanes,
                             Decision* decisions, PassUp up) {
    const hn::CappedTag<double, 8> d;
    Decision said[8];
    const auto see = [&](std::size_t i) HWY_ATTR { return seen_lanes(d, block, i); };
    const std::uint32_t unsure = decide_lanes<true>(d, 8, said, see);
    for_each_lane(lanes, [&](std::size_t lane) {
        const bool sure = (unsure >> lane & 1) == 0;
        decisions[lane] = sure ? Decision{said[lane].answer, 1} : up(&block, lane, 2);
    });
}

void proven_double_pairs(std::span<const TrianglePairBlock<double>> blocks,
                         std::span<Decision> decisions, PassUp up) {
    // Rounded and judged in turns of 64 pairs: a float that was only just stored loads slowly.
    constexpr std::size_t sixteens = 4, turn = 16 * sixteens;
    const hn::CappedTag<float, 16> d;
    RoundedPairs rounded[sixteens];
    for (std::size_t k = 0; k < decisions.size(); k += turn) {
        const std::size_t n = std::min(decisions.size() - k, turn);
        const auto block = [&](std::size_t i) HWY_ATTR -> const TrianglePairBlock<double>& {
            return blocks[(k + std::min(i, n - 1)) / 8]; // the last one twice
        };
        for (std::size_t i = 0; i < n; i += 16) {
            rounded[i / 16].round(block(i), 0);
            rounded[i / 16].round(block(i + 8), 8);
        }
        for (std::size_t i = 0; i < n; i += 16) {
            Sixteen said(&decisions[k + i], n - i);
            const auto see = [&](std::size_t j) HWY_ATTR { return rounded[i / 16].see(d, j); };
            const std::uint32_t unsure = said.among(decide_lanes<true>(d, 16, said.data(), see));
            if ((unsure & 0xff) != 0)
                reconsider(block(i), unsure & 0xff, said.data(), up);
            if (unsure >> 8 != 0)
                reconsider(block(i + 8), unsure >> 8, said.data() + 8, up);
        }
    }
}

} // namespace
} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(float_pairs);
HWY_EXPORT(proven_float_pairs);
HWY_EXPORT(proven_double_pairs);

template <>
void GuigueDevillersF32Batch::intersect(std::span<const TrianglePairBlock<float>> blocks,
                                        std::span<Decision> decisions) {
    HWY_DYNAMIC_DISPATCH(float_pairs)(blocks, decisions, pass_up<float, GuigueDevillersF32>);
}
template <>
void GuigueDevillersExactF32Batch::intersect(std::span<const TrianglePairBlock<float>> blocks,
                                             std::span<Decision> decisions) {
    HWY_DYNAMIC_DISPATCH(proven_float_pairs)
    (blocks, decisions, pass_up<float, GuigueDevillersExact>);
}
template <>
void GuigueDevillersExactBatch::intersect(std::span<const TrianglePairBlock<double>> blocks,
                                          std::span<Decision> decisions) {
    HWY_DYNAMIC_DISPATCH(proven_double_pairs)
    (blocks, decisions, pass_up<double, GuigueDevillersExact>);
}

} // namespace boxwood
#endif
