// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_RAY_TRIANGLE_BLOCK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_RAY_TRIANGLE_BLOCK_INL_H
#undef BOXWOOD_RAY_TRIANGLE_BLOCK_INL_H
#else
#define BOXWOOD_RAY_TRIANGLE_BLOCK_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/ray_triangle/ray_kernel.h"
#include "kernels/ray_triangle/triangle_block.h"

#include <cstdint>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

/// The lanes of a block that a ray hits, as bits, and their t, u and v: for each lane bit for bit
/// what K::intersect says. This one calls it lane by lane; kernels with a SIMD test overload it.
template <RayKernel K, std::size_t lanes>
HWY_INLINE std::uint32_t intersect_block(std::type_identity<K>, const typename K::PerRay& per_ray,
                                         const Ray<float>& ray, const TriangleBlock<lanes>& block,
                                         float t_max, BlockHits<lanes>& hits) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < lanes; ++i) {
        RayHit hit;
        if (!K::intersect(per_ray, ray, block.triangle(i), t_max, hit))
            continue;
        bits |= 1u << i;
        hits.t[i] = hit.t;
        hits.u[i] = hit.u;
        hits.v[i] = hit.v;
    }
    return bits;
}

/// The lanes of a mask, at most 16, as bits from bit `first` on.
template <class D, class M> HWY_INLINE std::uint32_t lane_bits(D d, M m, std::size_t first) {
    std::uint8_t bytes[8] = {};
    hwy::HWY_NAMESPACE::StoreMaskBits(d, m, bytes);
    return (bytes[0] | std::uint32_t{bytes[1]} << 8) << first;
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
