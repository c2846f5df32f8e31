// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide8_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "kernels/ray_triangle/moller_trumbore_block-inl.h"
#include "kernels/ray_triangle/watertight_block-inl.h"
#include "trees/layouts/wide.h"
#include "trees/traversals/ray_walk.h"
#include "trees/traversals/rays.h"

#include <bit>
#include <vector>

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

/// Where a block keeps the near and the far planes of each axis, for one ray.
struct PlaneOrder {
    std::size_t near[3], far[3];

    explicit PlaneOrder(const RaySlabs& ray) {
        for (std::size_t k = 0; k < 3; ++k) {
            near[k] = ray.negative[k] ? 3 + k : k;
            far[k] = ray.negative[k] ? k : 3 + k;
        }
    }
};

/// `clip` of kernels/ray_box/slabs.h for eight boxes, operation for operation: the lanes that the
/// ray hits as bits, and where it enters each.
HWY_INLINE std::uint32_t Clip(const Block8& block, const RaySlabs& ray, const PlaneOrder& order,
                              float t_min, float t_max, float* entry) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 8; i += hn::Lanes(df)) {
        const auto entry_at = [&](std::size_t k, float origin, float rdir) HWY_ATTR {
            return hn::Mul(
                hn::Sub(hn::Load(df, block.plane[order.near[k]] + i), hn::Set(df, origin)),
                hn::Set(df, rdir));
        };
        const auto exit_at = [&](std::size_t k, float origin, float rdir) HWY_ATTR {
            return hn::Mul(
                hn::Sub(hn::Load(df, block.plane[order.far[k]] + i), hn::Set(df, origin)),
                hn::Set(df, rdir));
        };
        auto t0 = hn::Set(df, t_min), t1 = hn::Set(df, t_max);
        t0 = LaterOf(entry_at(0, ray.origin.x, ray.entry_rdir.x), t0);
        t1 = EarlierOf(exit_at(0, ray.origin.x, ray.exit_rdir.x), t1);
        t0 = LaterOf(entry_at(1, ray.origin.y, ray.entry_rdir.y), t0);
        t1 = EarlierOf(exit_at(1, ray.origin.y, ray.exit_rdir.y), t1);
        t0 = LaterOf(entry_at(2, ray.origin.z, ray.entry_rdir.z), t0);
        t1 = EarlierOf(exit_at(2, ray.origin.z, ray.exit_rdir.z), t1);
        t0 = hn::Sub(t0, hn::Set(df, ray.margin));
        hn::StoreU(t0, df, entry + i);
        bits |= LaneBits(df, hn::Le(t0, t1), i);
    }
    return bits;
}

template <RayKernel K, bool Any, bool Counted>
RayHit WalkRay(const Wide8Layout& tree, const Ray<float>& ray, const RayJob& job,
               WaitingBlock* stack) {
    RayWalk<K, Counted> state(ray, tree.block(tree.root()).bounds, job.work);
    const PlaneOrder order(state.slabs);
    std::size_t top = 0;
    float entry[8];
    BlockHits<8> hits;
    WaitingBlock at{tree.root(), ray.t_min};
    for (;;) {
        if (Wide8Layout::is_leaf(at.ref)) {
            const TriangleBlock<8>& block = job.triangles[Wide8Layout::index(at.ref)];
            const std::uint32_t bits = IntersectBlock(std::type_identity<K>{}, state.per_ray, ray,
                                                      block, state.t_max(), hits);
            state.tested(block, bits, hits);
            if (Any && bits != 0)
                return state.result();
        } else {
            const Block8& block = tree.block(at.ref);
            state.count(8, top);
            std::uint32_t bits =
                Clip(block, state.slabs, order, state.t_min(), state.t_max(), entry);
            if (bits != 0) {
                // The nearest is opened next; the others wait, sorted. Few are hit: insertion is
                // quickest.
                auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
                at = {block.ref[lane], entry[lane]};
                const std::size_t base = top;
                while ((bits &= bits - 1) != 0) {
                    lane = static_cast<std::uint32_t>(std::countr_zero(bits));
                    WaitingBlock other{block.ref[lane], entry[lane]};
                    if (Any || other.entry < at.entry)
                        std::swap(other, at);
                    std::size_t place = top++;
                    if constexpr (!Any)
                        for (; place > base && stack[place - 1].entry < other.entry; --place)
                            stack[place] = stack[place - 1];
                    stack[place] = other;
                }
                continue;
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

/// The triangles of a leaf are in the block of the same index; those of inner blocks stay unused.
TriangleBlocks triangles_of(const Wide8Layout& tree, const TriangleMesh& mesh) {
    TriangleBlocks triangles(tree.blocks().size());
    std::vector<std::uint32_t> open;
    if (!tree.empty())
        open.push_back(tree.root());
    while (!open.empty()) {
        const std::uint32_t ref = open.back();
        open.pop_back();
        const Block8& block = tree.block(ref);
        if (!Wide8Layout::is_leaf(ref)) {
            open.insert(open.end(), block.ref, block.ref + block.count);
            continue;
        }
        for (std::uint32_t lane = 0; lane < 8; ++lane) {
            const std::uint32_t triangle = block.ref[lane < block.count ? lane : 0];
            triangles[Wide8Layout::index(ref)].set(lane, mesh.triangle(triangle), triangle);
        }
    }
    return triangles;
}

void rays(const Wide8Layout& tree, std::span<const Ray<float>> rays, RayQuery query,
          std::string_view kernel, const TriangleBlocks& triangles, const Executor& executor,
          std::span<RayHit> hits) {
    for_ray_chunks({rays, query, kernel, triangles, hits}, executor, [&](const RayJob& part) {
        HWY_DYNAMIC_DISPATCH(Rays)(tree, part);
    });
}

Work rays_counted(const Wide8Layout& tree, std::span<const Ray<float>> rays, RayQuery query,
                  std::string_view kernel, const TriangleBlocks& triangles,
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
