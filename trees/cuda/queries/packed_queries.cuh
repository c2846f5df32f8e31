#pragma once

// Few queries and many boxes: a warp per query and part of a packed layout, so that the parts of
// one query are searched side by side.

#include "trees/cuda/queries/packed_traversal.cuh"
#include "trees/cuda/queries/rays.cuh"
#include "trees/cuda/queries/regions.cuh"

namespace boxwood::cuda {

/// Fewer queries than these are cut into parts.
constexpr std::uint32_t enough_warps = 1024;

/// The highest level of which there are enough blocks for so many warps to have work.
inline unsigned level_of_parts(const PackedView& tree, std::uint32_t n_queries,
                               std::uint32_t n_warps = enough_warps) {
    unsigned level = tree.depth > 0 ? tree.depth - 1 : 0;
    while (level > 1 && std::uint64_t{tree.size(level)} * n_queries < n_warps)
        --level;
    return level;
}

/// Whether all that is known of a block from above lets a part begin there.
template <class Admits>
__device__ bool admits_part(const PackedView& tree, unsigned level, std::uint32_t part,
                            const Admits& admits) {
    return level + 1 == tree.depth ||
           admits(
               lane_box(tree.blocks[tree.first[level + 1] + part / tree.width], part % tree.width));
}

/// Calls test(slot, has) by two leaves at a time, of those that PackedTraversal meets.
template <class Test>
__device__ void for_slots(const PackedView& tree, unsigned lanes, std::uint32_t leaves,
                          const Test& test) {
    for (LanesByTwo two(lanes); two.next();) {
        const std::uint32_t leaf = __shfl_sync(~0u, leaves, two.lane);
        const std::uint32_t slot = leaf * tree.width + threadIdx.x % tree.width;
        test(slot, two.is_there && slot < tree.n);
    }
}

/// A warp per region and block of `level`: at[region * tree.size(level) + block] is its place.
template <Pass pass, class Region>
__global__ void packed_regions(PackedView tree, unsigned level, const Region* regions,
                               std::uint32_t n, AnswersTo<RegionAnswer<pass>> to) {
    __shared__ std::uint32_t stacks[traversal_warps][PackedTraversal::room];
    __shared__ RegionAnswer<pass> held[traversal_warps]
                                      [WarpAnswers<pass, RegionAnswer<pass>>::n_held];
    const unsigned warp = threadIdx.x / 32;
    const std::uint64_t place = std::uint64_t{blockIdx.x} * traversal_warps + warp;
    const auto query = static_cast<std::uint32_t>(place / tree.size(level)),
               part = static_cast<std::uint32_t>(place % tree.size(level));
    if (query >= n) // all lanes of the warp or none
        return;
    const Region region = regions[query];
    const auto admits = admits_of(region);
    WarpAnswers<pass, RegionAnswer<pass>> answers(to, place, held[warp]);
    if (holds_any(region) && admits_part(tree, level, part, admits))
        PackedTraversal(tree, stacks[warp])
            .run(tree.first[level] + part, 0, admits,
                 [&](unsigned lanes, std::uint32_t leaves, const Box&) {
                     for_slots(tree, lanes, leaves, [&](std::uint32_t slot, bool has) {
                         const bool hit = has && admits(lane_box(tree.blocks[slot / tree.width],
                                                                 slot % tree.width));
                         answers.add(hit,
                                     [&] { return region_answer<pass>(query, tree.items[slot]); });
                     });
                 });
    answers.finish();
}

/// The items whose boxes share a point with each region, n * tree.size(level) places in `to`: the
/// parts of a region side by side. sort_answers puts them into the order of the CPU.
template <Pass pass, class Region>
void find_in_regions(const PackedView& tree, unsigned level, const Region* regions, std::uint32_t n,
                     const AnswersTo<RegionAnswer<pass>>& to, Stream stream) {
    if (tree.n > 0)
        launch(stream, blocks_for(std::size_t{n} * tree.size(level), traversal_warps),
               traversal_threads, packed_regions<pass, Region>, tree, level, regions, n, to);
}

/// The closest of the hits of all lanes, or that of the lowest triangle, in all of them.
__device__ inline RayHit closest_of_warp(RayHit hit) {
    for (unsigned step = 16; step > 0; step /= 2) {
        const RayHit other{__shfl_xor_sync(~0u, hit.t, step), __shfl_xor_sync(~0u, hit.u, step),
                           __shfl_xor_sync(~0u, hit.v, step),
                           __shfl_xor_sync(~0u, hit.triangle, step)};
        if (BeforeInAnswers{}(other, hit))
            hit = other;
    }
    return hit;
}

/// A warp per ray: the closest hit.
template <RayKernel K> __global__ void packed_rays(RaysView<PackedView> view, RayHit* hits) {
    __shared__ std::uint32_t stacks[traversal_warps][PackedTraversal::room];
    const unsigned warp = threadIdx.x / 32;
    const std::uint32_t i = blockIdx.x * traversal_warps + warp;
    if (i >= view.n)
        return;
    const Ray<float> ray = view.rays[view.ray(i)];
    RayHit best{ray.t_max, 0, 0, no_triangle};
    if (view.tree.n > 0 && is_finite(ray.origin) && is_finite(ray.direction)) {
        const auto per_ray = K::prepare(ray);
        const RaySlabs slabs(
            ray, half_warp_bounds(lane_box(view.tree.blocks[view.tree.root()], threadIdx.x % 16)));
        const auto admits = [&](const Box& box) {
            return clip(slabs, box, ray.t_min, best.t).hit();
        };
        PackedTraversal(view.tree, stacks[warp])
            .run(view.tree.root(), 0, admits,
                 [&](unsigned lanes, std::uint32_t leaves, const Box&) {
                     for_slots(view.tree, lanes, leaves, [&](std::uint32_t slot, bool has) {
                         RayHit hit{};
                         const bool is_hit =
                             has &&
                             admits(lane_box(view.tree.blocks[slot / view.tree.width],
                                             slot % view.tree.width)) &&
                             K::intersect(per_ray, ray, view.triangles[slot], best.t, hit);
                         if (!__any_sync(~0u, is_hit))
                             return;
                         if (is_hit) {
                             hit.triangle = view.tree.items[slot];
                             best = BeforeInAnswers{}(hit, best) ? hit : best;
                         }
                         best = closest_of_warp(best);
                     });
                 });
    }
    if (threadIdx.x % 32 == 0)
        hits[view.ray(i)] = best.hit() ? best : RayHit{};
}

/// hits[i] answers rays[i]; triangles by slot of the packed layout.
template <RayKernel K>
void find_closest_hits(const RaysView<PackedView>& view, RayHit* hits, Stream stream) {
    launch(stream, blocks_for(view.n, traversal_warps), traversal_threads, packed_rays<K>, view,
           hits);
}

} // namespace boxwood::cuda
