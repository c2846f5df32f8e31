#pragma once

#include "kernels/primitives/triangle.h"
#include "kernels/ray_box/slabs.h"
#include "kernels/ray_triangle/ray_kernel.h"
#include "trees/cuda/queries/radix_pairs.cuh"
#include "trees/cuda/queries/sorted_answers.cuh"
#include "trees/ordering/ray_codes.h"
#include "trees/queries/rays.h"

namespace boxwood::cuda {

/// Indexed triangles: three corners each.
struct MeshView {
    const Vec3<float>* vertices;
    const std::uint32_t* corners;
    std::uint32_t n;

    __device__ Triangle<float> triangle(std::uint32_t i) const {
        const std::uint32_t* const at = corners + std::size_t{3} * i;
        return {vertices[at[0]], vertices[at[1]], vertices[at[2]]};
    }
};

/// A thread per triangle.
__global__ void bound_triangles(MeshView mesh, Box* boxes) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < mesh.n)
        boxes[i] = mesh.triangle(i).bounds();
}

/// A thread per slot: its triangle.
__global__ void gather_triangles(MeshView mesh, const std::uint32_t* items,
                                 Triangle<float>* triangles) {
    const std::uint32_t slot = blockIdx.x * blockDim.x + threadIdx.x;
    if (slot < mesh.n)
        triangles[slot] = mesh.triangle(items[slot]);
}

/// Rays at the triangles of a tree: those whose boxes it was made of, by slot. The range of both is
/// that of trees/queries/rays.h; a ray that is not finite is a miss.
template <class Tree> struct RaysView {
    Tree tree;
    const Triangle<float>* triangles;
    const Ray<float>* rays;
    std::uint32_t n;
    const std::uint32_t* order; ///< in which rays share warps, as ray_codes; null: as they are

    __device__ std::uint32_t ray(std::uint32_t i) const { return order ? order[i] : i; }
};

/// A thread per ray: the code by which the CPU's ray_order sorts, and the ray's number to be sorted
/// with.
__global__ void ray_codes(const Ray<float>* rays, std::uint32_t n, EntryGrid grid,
                          std::uint32_t* codes, std::uint32_t* numbers) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) {
        codes[i] = grid.code(rays[i]);
        numbers[i] = i;
    }
}

/// Calls test(slot) for every leaf whose box the ray may hit at [ray.t_min, t_max], the nearer
/// child first, until it says true. `t_max` may become less. False: there was no room for what
/// waits, and not all were seen; never in this tree.
template <class Test>
__device__ bool trace(const RadixTreeView& tree, const Ray<float>& ray, const float& t_max,
                      const Test& test) {
    struct Waiting {
        std::uint32_t ref;
        float entry;
    };
    Waiting stack[radix_depth];
    unsigned depth = 0;
    std::uint32_t at = *tree.root;
    const RaySlabs slabs(ray, tree.box(at));
    const auto span_of = [&](std::uint32_t ref) {
        return clip(slabs, tree.box(ref), ray.t_min, t_max);
    };
    if (!span_of(at).hit())
        return true;
    for (;;) {
        if (RadixTreeView::is_leaf(at)) {
            if (test(RadixTreeView::slot(at)))
                return true;
        } else {
            const std::uint32_t left = tree.nodes[at].left, right = tree.nodes[at].right;
            const RaySpan in_left = span_of(left), in_right = span_of(right);
            if (in_left.hit() && in_right.hit()) {
                const bool left_first = !(in_right.entry < in_left.entry);
                stack[depth++] =
                    left_first ? Waiting{right, in_right.entry} : Waiting{left, in_left.entry};
                at = left_first ? left : right;
                continue;
            }
            if (in_left.hit() || in_right.hit()) {
                at = in_left.hit() ? left : right;
                continue;
            }
        }
        do {
            if (depth == 0)
                return true;
            --depth;
        } while (stack[depth].entry > t_max);
        at = stack[depth].ref;
    }
}

/// A thread per ray: the closest hit, of equal ones that of the lowest triangle; or any.
template <class Tree, RayKernel K, RayQuery query>
__global__ void trace_rays(RaysView<Tree> view, RayHit* hits) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= view.n)
        return;
    const Ray<float> ray = view.rays[view.ray(i)];
    RayHit best{ray.t_max, 0, 0, no_triangle};
    if (view.tree.n > 0 && is_finite(ray.origin) && is_finite(ray.direction)) {
        const auto per_ray = K::prepare(ray);
        const auto test = [&](std::uint32_t slot) {
            RayHit hit{};
            if (K::intersect(per_ray, ray, view.triangles[slot], best.t, hit)) {
                hit.triangle = view.tree.items[slot];
                if (hit.t < best.t || hit.triangle < best.triangle)
                    best = hit;
            }
            return query == RayQuery::any && best.hit();
        };
        if (!trace(view.tree, ray, best.t, test))
            for (std::uint32_t slot = 0; slot < view.tree.n && !test(slot); ++slot)
                ;
    }
    hits[view.ray(i)] = best.hit() ? best : RayHit{};
}

/// A hit of a ray, for answers in any order.
struct HitOfRay {
    RayHit hit;
    std::uint32_t ray;
};
template <Pass pass> using RayAnswer = std::conditional_t<pass == Pass::capped, HitOfRay, RayHit>;

/// A thread per ray: all hits. In any order only in a tree with room for what waits.
template <class Tree, RayKernel K, Pass pass>
__global__ void trace_all(RaysView<Tree> view, AnswersTo<RayAnswer<pass>> to) {
    static_assert(pass != Pass::capped || std::is_same_v<Tree, RadixTreeView>);
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= view.n)
        return;
    const std::uint32_t number = view.ray(i);
    const Ray<float> ray = view.rays[number];
    ThreadAnswers<pass, RayAnswer<pass>> answers(to, number);
    if (view.tree.n > 0 && is_finite(ray.origin) && is_finite(ray.direction)) {
        const auto per_ray = K::prepare(ray);
        const auto test = [&](std::uint32_t slot) {
            RayHit hit{};
            if (K::intersect(per_ray, ray, view.triangles[slot], ray.t_max, hit)) {
                hit.triangle = view.tree.items[slot];
                if constexpr (pass == Pass::capped)
                    answers.add({hit, number});
                else
                    answers.add(hit);
            }
            return false;
        };
        if (!trace(view.tree, ray, ray.t_max, test)) {
            if constexpr (pass != Pass::capped) {
                answers.restart();
                for (std::uint32_t slot = 0; slot < view.tree.n; ++slot)
                    test(slot);
            }
        }
    }
    answers.finish();
}

constexpr unsigned ray_threads = 128;

/// hits[i] answers rays[i].
template <RayKernel K, RayQuery query, class Tree>
void find_hits(const RaysView<Tree>& view, RayHit* hits, Stream stream) {
    launch(stream, blocks_for(view.n, ray_threads), ray_threads, trace_rays<Tree, K, query>, view,
           hits);
}

/// All hits of each ray. sort_answers puts them into the order of the CPU.
template <RayKernel K, Pass pass, class Tree>
void find_all_hits(const RaysView<Tree>& view, const AnswersTo<RayAnswer<pass>>& to,
                   Stream stream) {
    launch(stream, blocks_for(view.n, ray_threads), ray_threads, trace_all<Tree, K, pass>, view,
           to);
}

} // namespace boxwood::cuda
