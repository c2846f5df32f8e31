// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_WATERTIGHT_BLOCK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_WATERTIGHT_BLOCK_INL_H
#undef BOXWOOD_WATERTIGHT_BLOCK_INL_H
#else
#define BOXWOOD_WATERTIGHT_BLOCK_INL_H
#endif

#include "kernels/ray_triangle/watertight.h"
#include "kernels/simd/ray_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

/// Watertight::intersect operation for operation: all lanes in float, and those that it does not
/// reject (few: the ray must meet the triangle, or nearly) one by one.
template <std::size_t lanes>
HWY_INLINE std::uint32_t
intersect_block(std::type_identity<Watertight>, const Watertight::PerRay& r, const Ray<float>& ray,
                const TriangleBlock<lanes>& block, float t_max, BlockHits<lanes>& hits) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<float, lanes> df;
    using Float = hn::Vec<decltype(df)>;
    const Float zero = hn::Zero(df);
    alignas(4 * lanes) float sheared[9][lanes]; // of the open lanes: a.x, a.y, a.z, b.x ...
    std::uint32_t open = 0;
    for (std::size_t i = 0; i < lanes; i += hn::Lanes(df)) {
        const auto depth = [&](int corner) HWY_ATTR {
            return hn::Sub(hn::Load(df, block.corner[corner][r.z] + i), hn::Set(df, r.origin_z));
        };
        const auto along_x = [&](int corner, Float z) HWY_ATTR {
            return hn::Sub(
                hn::Sub(hn::Load(df, block.corner[corner][r.x] + i), hn::Set(df, r.origin_x)),
                hn::Mul(hn::Set(df, r.shear_x), z));
        };
        const auto along_y = [&](int corner, Float z) HWY_ATTR {
            return hn::Sub(
                hn::Sub(hn::Load(df, block.corner[corner][r.y] + i), hn::Set(df, r.origin_y)),
                hn::Mul(hn::Set(df, r.shear_y), z));
        };
        const Float az = depth(0), bz = depth(1), cz = depth(2);
        const Float ax = along_x(0, az), bx = along_x(1, bz), cx = along_x(2, cz);
        const Float ay = along_y(0, az), by = along_y(1, bz), cy = along_y(2, cz);
        const Float u = hn::Sub(hn::Mul(cx, by), hn::Mul(cy, bx));
        const Float v = hn::Sub(hn::Mul(ax, cy), hn::Mul(ay, cx));
        const Float w = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
        const auto negative = hn::Or(hn::Lt(u, zero), hn::Or(hn::Lt(v, zero), hn::Lt(w, zero)));
        const auto positive = hn::Or(hn::Gt(u, zero), hn::Or(hn::Gt(v, zero), hn::Gt(w, zero)));
        const auto mixed = hn::And(negative, positive);
        if (hn::AllTrue(df, mixed))
            continue;
        open |= lane_bits(df, hn::Not(mixed), i);
        hn::Store(ax, df, sheared[0] + i);
        hn::Store(ay, df, sheared[1] + i);
        hn::Store(az, df, sheared[2] + i);
        hn::Store(bx, df, sheared[3] + i);
        hn::Store(by, df, sheared[4] + i);
        hn::Store(bz, df, sheared[5] + i);
        hn::Store(cx, df, sheared[6] + i);
        hn::Store(cy, df, sheared[7] + i);
        hn::Store(cz, df, sheared[8] + i);
    }
    std::uint32_t bits = 0;
    for (; open != 0; open &= open - 1) {
        const auto i = static_cast<std::size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(open));
        const auto corner = [&](int k) HWY_ATTR {
            return Watertight::Sheared{sheared[3 * k][i], sheared[3 * k + 1][i],
                                       sheared[3 * k + 2][i]};
        };
        const Watertight::Decision decision =
            Watertight::decide(r, ray, corner(0), corner(1), corner(2), t_max);
        bits |= std::uint32_t{decision.hit} << i;
        hits.t[i] = decision.t;
        hits.u[i] = decision.u;
        hits.v[i] = decision.v;
    }
    return bits;
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
