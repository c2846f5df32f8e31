// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_MOLLER_TRUMBORE_BLOCK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_MOLLER_TRUMBORE_BLOCK_INL_H
#undef BOXWOOD_MOLLER_TRUMBORE_BLOCK_INL_H
#else
#define BOXWOOD_MOLLER_TRUMBORE_BLOCK_INL_H
#endif

#include "kernels/ray_triangle/moller_trumbore.h"
#include "kernels/simd/ray_block-inl.h"
#include "kernels/simd/vec3-inl.h"

#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

/// MollerTrumbore::intersect operation for operation, a register at a time.
template <class Real, std::size_t lanes>
HWY_INLINE std::uint32_t intersect_block(std::type_identity<MollerTrumbore<Real>>,
                                         const typename MollerTrumbore<Real>::PerRay& per_ray,
                                         const Ray<float>& ray, const TriangleBlock<lanes>& block,
                                         float t_max, BlockHits<lanes>& hits) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<Real, lanes> dr;
    const hn::Rebind<float, decltype(dr)> df;
    using V = hn::Vec<decltype(dr)>;
    const V zero = hn::Zero(dr);
    const auto everywhere = [&](Vec3<Real> p) HWY_ATTR {
        return LaneVec3<V>{hn::Set(dr, p.x), hn::Set(dr, p.y), hn::Set(dr, p.z)};
    };
    const auto to_float = [&](V x) HWY_ATTR {
        if constexpr (std::is_same_v<Real, float>)
            return x;
        else
            return hn::DemoteTo(df, x);
    };
    const LaneVec3<V> direction = everywhere(per_ray.direction);
    const LaneVec3<V> origin = everywhere(per_ray.origin);
    // Bounds of t around the exact ones, so that most triangles need no division: 2^-20 is more
    // than all roundings, FLT_MIN and 2^-120 are more than what underflows.
    constexpr Real slack = Real(0x1p-20f), min_normal = std::numeric_limits<float>::min();
    const V far_t = hn::Set(dr, Real{t_max} + std::abs(Real{t_max}) * slack + min_normal);
    const V near_t = hn::Set(dr, Real{ray.t_min} - std::abs(Real{ray.t_min}) * slack - min_normal);
    const V underflow = hn::Set(dr, Real(0x1p-120f));
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < lanes; i += hn::Lanes(dr)) {
        const auto load = [&](int k, int axis) HWY_ATTR {
            if constexpr (std::is_same_v<Real, float>)
                return hn::Load(df, block.corner[k][axis] + i);
            else
                return hn::PromoteTo(dr, hn::Load(df, block.corner[k][axis] + i));
        };
        const auto corner = [&](int k) HWY_ATTR {
            return LaneVec3<V>{load(k, 0), load(k, 1), load(k, 2)};
        };
        const LaneVec3<V> a = corner(0), e1 = corner(1) - a, e2 = corner(2) - a;
        const LaneVec3<V> p = cross(direction, e2);
        const V det = dot(e1, p), size = hn::Abs(det);
        const LaneVec3<V> s = origin - a, q = cross(s, e1);
        const V sign = hn::And(hn::SignBit(dr), det);
        const V u = hn::Xor(sign, dot(s, p)), v = hn::Xor(sign, dot(direction, q));
        const V t_det = dot(e2, q), t_size = hn::Xor(sign, t_det);
        const auto about = hn::And(hn::Le(t_size, hn::MulAdd(size, far_t, underflow)),
                                   hn::Ge(t_size, hn::MulSub(size, near_t, underflow)));
        const auto inside = hn::And(hn::And(hn::And(hn::Ge(u, zero), hn::Ge(v, zero)), about),
                                    hn::Le(hn::Add(u, v), size));
        if (hn::AllFalse(dr, inside))
            continue;
        const V t_real = hn::Add(hn::Div(t_det, det), zero);
        const auto t = to_float(t_real);
        const V infinity = hn::Set(dr, std::numeric_limits<Real>::infinity());
        // What rounds to an infinite float; Highway's scalar DemoteTo makes it FLT_MAX.
        const V beyond = std::is_same_v<Real, float> ? infinity : hn::Set(dr, Real(0x1.ffffffp127));
        const auto from_t_min =
            hn::And(hn::And(inside, hn::Lt(size, infinity)),
                    hn::And(hn::Ge(t_real, hn::Set(dr, Real{ray.t_min})), hn::Lt(t_real, beyond)));
        const auto to_t_max = hn::Le(t, hn::Set(df, t_max));
        const std::uint32_t hit = lane_bits(dr, from_t_min, i) & lane_bits(df, to_t_max, i);
        if (hit == 0)
            continue;
        bits |= hit;
        hn::Store(t, df, hits.t + i);
        hn::Store(to_float(hn::Add(hn::Div(u, size), zero)), df, hits.u + i);
        hn::Store(to_float(hn::Add(hn::Div(v, size), zero)), df, hits.v + i);
    }
    return bits;
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
