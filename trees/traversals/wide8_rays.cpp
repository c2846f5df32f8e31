// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide8_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/layouts/wide8.h"
#include "trees/traversals/ray_walk.h"
#include "trees/traversals/rays.h"

#include <bit>

#ifndef BOXWOOD_WIDE8_RAYS_ONCE
#define BOXWOOD_WIDE8_RAYS_ONCE
namespace boxwood {

struct WaitingBlock {
    std::uint32_t ref;
    float entry;
};

} // namespace boxwood
#endif

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr hn::CappedTag<float, 8> df;

/// a > t ? a : t, and a < t ? a : t: where a is NaN the result is t. On x86 one instruction does
/// just that; others give NaN for NaN.
template <class V> HWY_INLINE V LaterOf(V a, V t) {
    return HWY_ARCH_X86 ? hn::Max(a, t) : hn::IfThenElse(hn::Gt(a, t), a, t);
}
template <class V> HWY_INLINE V EarlierOf(V a, V t) {
    return HWY_ARCH_X86 ? hn::Min(a, t) : hn::IfThenElse(hn::Lt(a, t), a, t);
}

/// `clip` of kernels/box_ray.h for eight boxes, operation for operation: the lanes that the ray
/// hits as bits, and where it enters each.
HWY_INLINE std::uint32_t Clip(const Block8& block, const RaySlabs& ray, float t_min, float t_max,
                              float* entry) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 8; i += hn::Lanes(df)) {
        auto t0 = hn::Set(df, t_min), t1 = hn::Set(df, t_max);
        for (int k = 0; k < 3; ++k) {
            const int near = ray.negative[static_cast<std::size_t>(k)] ? 3 + k : k;
            const int far = near < 3 ? 3 + k : k;
            const auto origin = hn::Set(df, ray.origin[k]);
            const auto a = hn::Mul(hn::Sub(hn::Load(df, block.plane[near] + i), origin),
                                   hn::Set(df, ray.entry_rdir[k]));
            const auto b = hn::Mul(hn::Sub(hn::Load(df, block.plane[far] + i), origin),
                                   hn::Set(df, ray.exit_rdir[k]));
            t0 = LaterOf(a, t0);
            t1 = EarlierOf(b, t1);
        }
        hn::StoreU(t0, df, entry + i);
        std::uint8_t part[8] = {};
        hn::StoreMaskBits(df, hn::Le(t0, t1), part);
        bits |= std::uint32_t{part[0]} << i;
    }
    return bits;
}

template <RayKernel K, bool Any, bool Counted>
RayHit WalkRay(const Wide8Layout& tree, const Ray<float>& ray, const RayJob& job,
               WaitingBlock* stack) {
    RayWalk<K, Counted> state(ray, job.triangles, job.work);
    std::size_t top = 0;
    float entry[8];
    WaitingBlock at{tree.root(), ray.t_min};
    for (;;) {
        const Block8& block = tree.block(at.ref);
        state.count(8, top);
        std::uint32_t bits = Clip(block, state.slabs, state.t_min(), state.t_max(), entry);
        if (Wide8Layout::is_leaf(at.ref)) {
            for (; bits; bits &= bits - 1) {
                const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
                if (!(entry[lane] > state.t_max()))
                    state.test(block.first + lane);
                if (Any && state.hit())
                    return state.result();
            }
        } else if (bits) {
            // New entries are kept sorted, the nearest on top; few are hit, so insertion is
            // quickest.
            const std::size_t base = top;
            for (; bits; bits &= bits - 1) {
                const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
                std::size_t place = top++;
                if constexpr (!Any)
                    for (; place > base && stack[place - 1].entry < entry[lane]; --place)
                        stack[place] = stack[place - 1];
                stack[place] = {block.ref[lane], entry[lane]};
            }
        }
        do {
            if (top == 0)
                return state.result();
            at = stack[--top];
        } while (at.entry > state.t_max());
    }
}

void Rays(const Wide8Layout& tree, const RayJob& job) {
    // Each open block on a path leaves at most seven others waiting, and its own eight come on top.
    Buffer<WaitingBlock> stack(8 * tree.depth() + 8);
    with_kernel<RayKernels>(job.kernel, [&]<class K>(std::type_identity<K>) HWY_ATTR {
        const bool any = job.query == RayQuery::any;
        const auto one = job.work ? (any ? WalkRay<K, true, true> : WalkRay<K, false, true>)
                                  : (any ? WalkRay<K, true, false> : WalkRay<K, false, false>);
        for (std::size_t i = 0; i < job.rays.size(); ++i)
            job.hits[i] = tree.empty() ? RayHit{} : one(tree, job.rays[i], job, stack.data());
    });
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(Rays);

void rays(const Wide8Layout& tree, std::span<const Ray<float>> rays, RayQuery query,
          std::string_view kernel, const OrderedTriangles& triangles, const Executor& executor,
          std::span<RayHit> hits) {
    for_ray_chunks({rays, query, kernel, triangles, hits}, executor, [&](const RayJob& part) {
        HWY_DYNAMIC_DISPATCH(Rays)(tree, part);
    });
}

Work rays_counted(const Wide8Layout& tree, std::span<const Ray<float>> rays, RayQuery query,
                  std::string_view kernel, const OrderedTriangles& triangles,
                  std::span<RayHit> hits) {
    Work work;
    for_ray_chunks({rays, query, kernel, triangles, hits, &work}, serial(),
                   [&](const RayJob& part) {
                       HWY_DYNAMIC_DISPATCH(Rays)
                       (tree, part);
                   });
    return work;
}

} // namespace boxwood
#endif
