// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_NODE_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_NODE_RAYS_INL_H
#undef BOXWOOD_NODE_RAYS_INL_H
#else
#define BOXWOOD_NODE_RAYS_INL_H
#endif

#include <hwy/highway.h>

#include "trees/traversals/ray_wave-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// All hits of one ray; nodes in no order.
template <class Node, RayKernel K>
HWY_INLINE void traverse_all(const TriangleBlocks& tree, const FusedSlabs& slabs,
                             const Ray<float>& ray, RayState<K, RayMode::all, false>& state,
                             std::uint32_t* waiting) {
    namespace hn = hwy::HWY_NAMESPACE;
    const NodeTag<Node> df;
    const hn::Rebind<std::uint32_t, decltype(df)> du;
    const NodeClip<Node> clip(slabs, state.t_min());
    const auto* nodes = reinterpret_cast<const Node*>(tree.nodes.data());
    const auto* blocks = reinterpret_cast<const RayBlock<Node>*>(tree.blocks.data());
    const auto t_max = hn::Set(df, state.t_max());
    BlockHits<ray_lanes<Node>> hits;
    waiting[0] = tree.root;
    std::size_t top = 1;
    while (top != 0) {
        const std::uint32_t at = waiting[--top];
        if (ray_refs::is_leaf(at)) {
            const RayBlock<Node>* block = blocks + ray_refs::index(at);
            const RayBlock<Node>* last = block + (Node::width > 8 && (at & ray_refs::two));
            do
                state.tested(*block,
                             intersect_block(std::type_identity<K>{}, state.per_ray, ray, *block,
                                             state.t_max(), hits),
                             hits);
            while (++block <= last);
        } else {
            const Node& node = nodes[at];
            for (std::size_t i = 0; i < Node::width; i += hn::Lanes(df)) {
                hn::Vec<decltype(df)> entry;
                const auto hit = hn::RebindMask(du, clip.hits_of(node, i, t_max, entry));
                hn::StoreU(compressed(du, hn::LoadU(du, node.ref + i), hit), du, waiting + top);
                top += hn::CountTrue(du, hit);
            }
        }
    }
}

template <class Node> void traverse_job(const RayJob& job) {
    const SlabBounds bounds(job.triangles.bounds);
    with_job_types(job, [&]<class K, RayMode mode, bool Counted>(
                            std::type_identity<K>, std::integral_constant<RayMode, mode>,
                            std::bool_constant<Counted>) HWY_ATTR {
        if constexpr (mode == RayMode::all) {
            Buffer<std::uint32_t> waiting(room_for<Node>(job.depth));
            for_each_ray<mode>(job,
                               [&](const Ray<float>& ray, std::vector<RayHit>& found) HWY_ATTR {
                                   RayState<K, mode, false> state(ray, nullptr, found);
                                   traverse_all<Node>(job.triangles, FusedSlabs(ray, bounds), ray,
                                                      state, waiting.data());
                                   return state.result();
                               });
        } else {
            RayWave<Node, K, mode, Counted>(job, bounds).run();
        }
    });
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
