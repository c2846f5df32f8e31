// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/ray_triangle/blocks.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "kernels/ray_triangle/blocks.h"
#include "kernels/registry.h"
#include "kernels/simd/moller_trumbore_block-inl.h"
#include "kernels/simd/watertight_block-inl.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {
namespace {

template <std::size_t lanes>
bool nearest(std::string_view kernel, std::span<const Ray<float>> rays,
             std::span<const TriangleBlock<lanes>> blocks, std::span<RayHit> hits) {
    return with_kernel<RayKernels>(kernel, [&]<class K>(std::type_identity<K> k) HWY_ATTR {
        BlockHits<lanes> found;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            RayHit best;
            for (std::uint32_t bits = intersect_block(k, K::prepare(rays[i]), rays[i], blocks[i],
                                                      rays[i].t_max, found);
                 bits != 0; bits &= bits - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
                const RayHit hit{found.t[lane], found.u[lane], found.v[lane], blocks[i].id[lane]};
                if (!best.hit() || hit.t < best.t ||
                    (hit.t == best.t && hit.triangle < best.triangle))
                    best = hit;
            }
            hits[i] = best;
        }
    });
}

bool nearest4(std::string_view kernel, std::span<const Ray<float>> rays,
              std::span<const TriangleBlock<4>> blocks, std::span<RayHit> hits) {
    return nearest(kernel, rays, blocks, hits);
}
bool nearest8(std::string_view kernel, std::span<const Ray<float>> rays,
              std::span<const TriangleBlock<8>> blocks, std::span<RayHit> hits) {
    return nearest(kernel, rays, blocks, hits);
}

} // namespace
} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(nearest4);
HWY_EXPORT(nearest8);

bool nearest_in_blocks(std::string_view kernel, std::span<const Ray<float>> rays,
                       std::span<const TriangleBlock<4>> blocks, std::span<RayHit> hits) {
    return HWY_DYNAMIC_DISPATCH(nearest4)(kernel, rays, blocks, hits);
}
bool nearest_in_blocks(std::string_view kernel, std::span<const Ray<float>> rays,
                       std::span<const TriangleBlock<8>> blocks, std::span<RayHit> hits) {
    return HWY_DYNAMIC_DISPATCH(nearest8)(kernel, rays, blocks, hits);
}

} // namespace boxwood
#endif
