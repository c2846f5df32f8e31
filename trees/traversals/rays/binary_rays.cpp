#include "kernels/arithmetic/rounding.h"
#include "kernels/ray_box/slabs.h"
#include "trees/layouts/binary.h"
#include "trees/traversals/rays/ray_traversal.h"
#include "trees/traversals/rays/ray_tree.h"

namespace boxwood::detail {
namespace {

struct Waiting {
    std::size_t node;
    float entry;
};

const Box& box_of(const TreeNode& node) { return node.box; }
Box box_of(const TreeNodeOf<double>& node) { return round_outward(node.box); }

using Block = TriangleBlock<8>;

template <class L, class State>
void trace(const L& layout, const Block* blocks, const Ray<float>& ray, State& state,
           Buffer<Waiting>& stack) {
    const auto& tree = layout.tree();
    const Box bounds = box_of(tree.nodes[0]);
    const RaySlabs slabs(ray, bounds);
    const auto entry = [&](std::size_t node) {
        return clip(slabs, box_of(tree.nodes[node]), state.t_min(), state.t_max());
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
            std::size_t near = tree.left(node), far = tree.right(node);
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
        state.test(blocks[slot / 8], slot % 8);
        if (state.done())
            return;
    }
}

template <class L> void traverse_job(const L& layout, const RayJob& job) {
    Buffer<Waiting> stack(layout.depth() + 1);
    const auto* blocks = reinterpret_cast<const Block*>(job.triangles.blocks.data());
    with_job_types(job, [&]<class K, RayMode mode, bool Counted>(
                            std::type_identity<K>, std::integral_constant<RayMode, mode>,
                            std::bool_constant<Counted>) {
        for_each_ray<mode>(job, [&](const Ray<float>& ray, std::vector<RayHit>& found) {
            RayState<K, mode, Counted> state(ray, job.work, found);
            trace(layout, blocks, ray, state, stack);
            return state.result();
        });
    });
}

template <class L>
TriangleBlocks blocks_in_order(const L& layout, const TriangleMesh& mesh,
                               const Executor& executor) {
    const Buffer<std::uint32_t>& order = layout.tree().order;
    const std::size_t n = (order.size() + 7) / 8;
    TriangleBlocks made;
    if (n == 0)
        return made;
    made.bounds = box_of(layout.tree().nodes[0]);
    require_ray_range(made.bounds);
    made.blocks = Buffer<std::byte>(n * sizeof(Block));
    auto* blocks = reinterpret_cast<Block*>(made.blocks.data());
    constexpr std::size_t row = 256;
    executor.for_each((n + row - 1) / row, [&](std::size_t r) {
        const std::size_t end = 8 * std::min(n, (r + 1) * row);
        for (std::size_t slot = 8 * row * r; slot < end; ++slot) {
            const std::uint32_t triangle = order[slot < order.size() ? slot : slot / 8 * 8];
            blocks[slot / 8].set(slot % 8, mesh.triangle(triangle), triangle);
        }
    });
    return made;
}

} // namespace

#define X(name, L)                                                                                 \
    void traverse_rays(const L& layout, const RayJob& job) { traverse_job(layout, job); }
BOXWOOD_BINARY_LAYOUTS(X)
#undef X

} // namespace boxwood::detail

namespace boxwood {

#define X(name, L)                                                                                 \
    TriangleBlocks triangles_of(const L& layout, const TriangleMesh& mesh,                         \
                                const Executor& executor) {                                        \
        return detail::blocks_in_order(layout, mesh, executor);                                    \
    }                                                                                              \
    SingleRayFunctions single_ray_functions(const L&, std::string_view) { return {}; }
BOXWOOD_BINARY_LAYOUTS(X)
#undef X

} // namespace boxwood
