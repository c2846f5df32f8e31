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

/// `clip` of kernels/ray_box/slabs.h for eight boxes, operation for operation: the lanes that the ray
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

/// The lanes of a block that a kernel does not reject at once, as bits: all, unless a version for
/// that kernel follows.
template <class PerRay>
HWY_INLINE std::uint32_t Candidates(const TriangleBlock8&, const Ray<float>&, const PerRay&) {
    return 0xff;
}

/// `Watertight` rejects where its float edge functions have both signs: the same, eight at a time.
HWY_INLINE std::uint32_t Candidates(const TriangleBlock8& block, const Ray<float>& ray,
                                    const Watertight::PerRay& per_ray) {
    const int z = per_ray.z, x = z == 2 ? 0 : z + 1, y = x == 2 ? 0 : x + 1;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 8; i += hn::Lanes(df)) {
        const auto from_origin = [&](int corner, int axis) HWY_ATTR {
            return hn::Sub(hn::Load(df, block.corner[corner][axis] + i),
                           hn::Set(df, ray.origin[axis]));
        };
        const auto along = [&](int corner, int axis, float shear) HWY_ATTR {
            return hn::Sub(from_origin(corner, axis),
                           hn::Mul(hn::Set(df, shear), from_origin(corner, z)));
        };
        const auto ax = along(0, x, per_ray.shear_x), ay = along(0, y, per_ray.shear_y);
        const auto bx = along(1, x, per_ray.shear_x), by = along(1, y, per_ray.shear_y);
        const auto cx = along(2, x, per_ray.shear_x), cy = along(2, y, per_ray.shear_y);
        const auto u = hn::Sub(hn::Mul(cx, by), hn::Mul(cy, bx));
        const auto v = hn::Sub(hn::Mul(ax, cy), hn::Mul(ay, cx));
        const auto w = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
        const auto zero = hn::Zero(df);
        const auto some_negative =
            hn::Or(hn::Lt(u, zero), hn::Or(hn::Lt(v, zero), hn::Lt(w, zero)));
        const auto some_positive =
            hn::Or(hn::Gt(u, zero), hn::Or(hn::Gt(v, zero), hn::Gt(w, zero)));
        std::uint8_t part[8] = {};
        hn::StoreMaskBits(df, hn::Not(hn::And(some_negative, some_positive)), part);
        bits |= std::uint32_t{part[0]} << i;
    }
    return bits;
}

template <RayKernel K, bool Any, bool Counted>
RayHit WalkRay(const Wide8Layout& tree, const Ray<float>& ray, const RayJob& job,
               WaitingBlock* stack) {
    RayWalk<K, Counted> state(ray, job.work);
    std::size_t top = 0;
    float entry[8];
    WaitingBlock at{tree.root(), ray.t_min};
    for (;;) {
        if (Wide8Layout::is_leaf(at.ref)) {
            const TriangleBlock8& block = job.triangles[Wide8Layout::index(at.ref)];
            std::uint32_t bits = Candidates(block, ray, state.per_ray);
            state.count_rejected(8 - static_cast<unsigned>(std::popcount(bits)));
            for (; bits; bits &= bits - 1) {
                state.test(block, static_cast<std::uint32_t>(std::countr_zero(bits)));
                if (Any && state.hit())
                    return state.result();
            }
        } else {
            const Block8& block = tree.block(at.ref);
            state.count(8, top);
            std::uint32_t bits = Clip(block, state.slabs, state.t_min(), state.t_max(), entry);
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
        for (std::uint32_t lane = 0; lane < 8; ++lane)
            triangles[Wide8Layout::index(ref)].set(lane, mesh,
                                                   block.ref[lane < block.count ? lane : 0]);
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
