// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_OBB_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_OBB_LANES_INL_H
#undef BOXWOOD_OBB_LANES_INL_H
#else
#define BOXWOOD_OBB_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "trees/world/detail/pair_frame.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Eight boxes of B as seen from A.
struct alignas(64) SeenBoxes {
    float centre[3][8], axis[3][3][8];
    const float (*half)[8];

    SeenBox lane(std::size_t i) const {
        SeenBox box;
        for (std::size_t k = 0; k < 3; ++k) {
            box.centre[k] = centre[k][i];
            box.half[k] = half[k][i];
            for (std::size_t axis_ = 0; axis_ < 3; ++axis_)
                box.axis[k][axis_] = axis[k][axis_][i];
        }
        return box;
    }
};

constexpr hn::CappedTag<float, 8> d8;
using F8 = hn::Vec<decltype(d8)>;

/// Fused where there is an instruction for it: bounds allow for more roundings (PairFrame).
HWY_INLINE F8 dot3(F8 x, F8 y, F8 z, F8 a, F8 b, F8 c) {
    return hn::MulAdd(z, c, hn::MulAdd(y, b, hn::Mul(x, a)));
}

/// The lanes of a block of B seen from where t starts.
HWY_INLINE void see_lanes(const ObbBlock& block, const PairFrame& frame, const Vec3<double>& t,
                          SeenBoxes& seen) {
    seen.half = block.half;
    for (std::size_t i = 0; i < 8; i += hn::Lanes(d8)) {
        for (std::size_t row = 0; row < 3; ++row) {
            const F8 r0 = hn::Set(d8, frame.rotation[row][0]);
            const F8 r1 = hn::Set(d8, frame.rotation[row][1]);
            const F8 r2 = hn::Set(d8, frame.rotation[row][2]);
            const auto turned = [&](const float(&v)[3][8]) HWY_ATTR {
                return dot3(r0, r1, r2, hn::Load(d8, v[0] + i), hn::Load(d8, v[1] + i),
                            hn::Load(d8, v[2] + i));
            };
            const F8 from = hn::Set(d8, static_cast<float>(t[static_cast<int>(row)]));
            hn::Store(hn::Add(turned(block.centre), from), d8, seen.centre[row] + i);
            for (std::size_t k = 0; k < 3; ++k)
                hn::Store(turned(block.axis[k]), d8, seen.axis[k][row] + i);
        }
    }
}

/// From the centre of one box to those of the lanes [i, i + Lanes(d8)) of eight others.
struct CentreOffsets {
    F8 t[3];

    template <class Centre>
    HWY_INLINE CentreOffsets(const SeenBox& one, const Centre& centre, std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k)
            t[k] = hn::Sub(hn::Load(d8, centre[k] + i), hn::Set(d8, one.centre[k]));
    }
    HWY_INLINE F8 squared() const { return dot3(t[0], t[1], t[2], t[0], t[1], t[2]); }
};

/// How one box lies to the lanes of eight others: of_one(k, apart, sum) along each of its own three
/// axes, then of_lane(k, apart, sum) along theirs; how far the centres are apart along it, and the
/// sum of the half lengths. Axis by axis, since sixteen registers do not hold all.
template <class OfOne, class OfLane>
HWY_INLINE void along_six_axes(const SeenBox& one, const CentreOffsets& offsets,
                               const float (&axis)[3][3][8], const float (&half)[3][8],
                               std::size_t i, const OfOne& of_one, const OfLane& of_lane) {
    const F8(&t)[3] = offsets.t;
    F8 sum_of_lane[3];
    for (std::size_t k = 0; k < 3; ++k)
        sum_of_lane[k] = hn::Load(d8, half[k] + i);
    for (std::size_t k = 0; k < 3; ++k) {
        const F8 nx = hn::Set(d8, one.axis[k][0]), ny = hn::Set(d8, one.axis[k][1]),
                 nz = hn::Set(d8, one.axis[k][2]);
        const F8 own = hn::Set(d8, one.half[k]);
        F8 sum = own;
        for (std::size_t j = 0; j < 3; ++j) {
            const F8 cosine =
                hn::Abs(dot3(nx, ny, nz, hn::Load(d8, axis[j][0] + i), hn::Load(d8, axis[j][1] + i),
                             hn::Load(d8, axis[j][2] + i)));
            sum = hn::MulAdd(cosine, hn::Load(d8, half[j] + i), sum);
            sum_of_lane[j] = hn::MulAdd(cosine, own, sum_of_lane[j]);
        }
        of_one(k, hn::Abs(dot3(nx, ny, nz, t[0], t[1], t[2])), sum);
    }
    for (std::size_t j = 0; j < 3; ++j)
        of_lane(j,
                hn::Abs(dot3(hn::Load(d8, axis[j][0] + i), hn::Load(d8, axis[j][1] + i),
                             hn::Load(d8, axis[j][2] + i), t[0], t[1], t[2])),
                sum_of_lane[j]);
}

/// The greatest gap along an axis; below 0 where they overlap along all.
HWY_INLINE F8 greatest_gap(const SeenBox& one, const CentreOffsets& offsets,
                           const float (&axis)[3][3][8], const float (&half)[3][8], std::size_t i) {
    F8 gap = hn::Set(d8, -std::numeric_limits<float>::infinity());
    const auto take = [&](std::size_t, F8 apart, F8 sum)
                          HWY_ATTR { gap = hn::Max(gap, hn::Sub(apart, sum)); };
    along_six_axes(one, offsets, axis, half, i, take, take);
    return gap;
}

/// A bound of the distance from below, but for the frame's error: in the one's frame, in the
/// lane's, and along the line of centres.
HWY_INLINE F8 distance_bound(const SeenBox& one, const CentreOffsets& offsets,
                             const float (&axis)[3][3][8], const float (&half)[3][8],
                             std::size_t i) {
    const F8 zero = hn::Zero(d8);
    F8 squared = zero, squared_of_lane = zero;
    const F8 tt = offsets.squared();
    F8 left = tt;
    along_six_axes(
        one, offsets, axis, half, i,
        [&](std::size_t k, F8 apart, F8 sum) HWY_ATTR {
            const F8 gap = hn::Max(hn::Sub(apart, sum), zero);
            squared = hn::MulAdd(gap, gap, squared);
            left = hn::NegMulAdd(hn::Set(d8, one.half[k]), apart, left);
        },
        [&](std::size_t k, F8 apart, F8 sum) HWY_ATTR {
            const F8 gap = hn::Max(hn::Sub(apart, sum), zero);
            squared_of_lane = hn::MulAdd(gap, gap, squared_of_lane);
            left = hn::NegMulAdd(hn::Load(d8, half[k] + i), apart, left);
        });
    // left / |t|, squared; the quotient first, as left^2 may overflow.
    left = hn::Max(left, zero);
    const F8 along = hn::Mul(left, hn::Div(left, hn::Max(tt, hn::Set(d8, 0x1p-100f))));
    return hn::Mul(hn::Sqrt(hn::Max(hn::Max(squared, squared_of_lane), along)),
                   hn::Set(d8, 1 - 0x1p-20f));
}

/// The lane whose centre is nearest to a point of the block's frame, but for those tried;
/// ObbBlock::width if there is none.
HWY_INLINE std::size_t nearest_lane(const ObbBlock& block, const Vec3<double>& p,
                                    std::uint32_t* tried) {
    const F8 x = hn::Set(d8, static_cast<float>(p.x - block.own.centre[0])),
             y = hn::Set(d8, static_cast<float>(p.y - block.own.centre[1])),
             z = hn::Set(d8, static_cast<float>(p.z - block.own.centre[2]));
    alignas(64) float squared[8];
    for (std::size_t i = 0; i < 8; i += hn::Lanes(d8)) {
        const F8 dx = hn::Sub(hn::Load(d8, block.centre[0] + i), x);
        const F8 dy = hn::Sub(hn::Load(d8, block.centre[1] + i), y);
        const F8 dz = hn::Sub(hn::Load(d8, block.centre[2] + i), z);
        hn::Store(dot3(dx, dy, dz, dx, dy, dz), d8, squared + i);
    }
    std::size_t best = ObbBlock::width;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < block.count; ++i)
        if (!(tried && *tried >> i & 1) && squared[i] < least) {
            least = squared[i];
            best = i;
        }
    if (tried && best < ObbBlock::width)
        *tried |= 1u << best;
    return best;
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
