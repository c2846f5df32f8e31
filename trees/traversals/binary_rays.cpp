#include "trees/layouts/binary.h"
#include "trees/traversals/ray_walk.h"
#include "trees/traversals/rays.h"

namespace boxwood {
namespace {

struct Waiting {
    std::size_t node;
    float entry;
};

template <RayKernel K, bool Any, bool Counted>
RayHit walk(const BinaryLayout& layout, const Ray<float>& ray, const RayJob& job,
            Buffer<Waiting>& stack) {
    const Tree& tree = layout.tree();
    RayWalk<K, Counted> state(ray, tree.nodes[0].box, job.work);
    const auto entry = [&](std::size_t node) {
        return clip(state.slabs, tree.nodes[node].box, state.t_min(), state.t_max());
    };
    std::size_t top = 0;
    state.count(1, 0);
    if (const RaySpan span = entry(0); span.hit())
        stack[top++] = {0, span.entry};
    while (top > 0) {
        auto [node, node_entry] = stack[--top];
        if (node_entry > state.t_max())
            continue;
        while (!tree.is_leaf(node)) {
            state.count(2, top);
            std::size_t near = Tree::left(node), far = tree.right(node);
            RaySpan near_span = entry(near), far_span = entry(far);
            if (!near_span.hit() || (far_span.hit() && far_span.entry < near_span.entry)) {
                std::swap(near, far);
                std::swap(near_span, far_span);
            }
            if (!near_span.hit())
                break;
            if (far_span.hit())
                stack[top++] = {far, far_span.entry};
            node = near;
        }
        if (!tree.is_leaf(node))
            continue;
        const std::uint32_t slot = tree.nodes[node].first;
        state.test(job.triangles[slot / 8], slot % 8);
        if (Any && state.hit())
            break;
    }
    return state.result();
}

void walk_all(const BinaryLayout& layout, RayJob job, const Executor& executor) {
    for_ray_chunks(job, executor, [&](const RayJob& part) {
        with_kernel<RayKernels>(part.kernel, [&]<class K>(std::type_identity<K>) {
            Buffer<Waiting> stack(layout.depth() + 1);
            const bool any = part.query == RayQuery::any;
            const auto one = part.work ? (any ? walk<K, true, true> : walk<K, false, true>)
                                       : (any ? walk<K, true, false> : walk<K, false, false>);
            for (std::size_t i = 0; i < part.rays.size(); ++i)
                part.hits[i] =
                    layout.tree().empty() ? RayHit{} : one(layout, part.rays[i], part, stack);
        });
    });
}

} // namespace

TriangleBlocks triangles_of(const BinaryLayout& tree, const TriangleMesh& mesh) {
    const Buffer<std::uint32_t>& order = tree.tree().order;
    TriangleBlocks blocks((order.size() + 7) / 8);
    for (std::uint32_t slot = 0; slot < 8 * blocks.size(); ++slot) {
        const std::uint32_t triangle = order[slot < order.size() ? slot : slot / 8 * 8];
        blocks[slot / 8].set(slot % 8, mesh.triangle(triangle), triangle);
    }
    return blocks;
}

void rays(const BinaryLayout& tree, std::span<const Ray<float>> rays, RayQuery query,
          std::string_view kernel, const TriangleBlocks& triangles, const Executor& executor,
          std::span<RayHit> hits) {
    walk_all(tree, {rays, query, kernel, triangles, hits}, executor);
}

Work rays_counted(const BinaryLayout& tree, std::span<const Ray<float>> rays, RayQuery query,
                  std::string_view kernel, const TriangleBlocks& triangles,
                  std::span<RayHit> hits) {
    Work work;
    walk_all(tree, {rays, query, kernel, triangles, hits, &work}, serial());
    return work;
}

} // namespace boxwood
