// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_RAY_STEPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_RAY_STEPS_INL_H
#undef BOXWOOD_RAY_STEPS_INL_H
#else
#define BOXWOOD_RAY_STEPS_INL_H
#endif

#include "kernels/simd/moller_trumbore_block-inl.h"
#include "kernels/simd/watertight_block-inl.h"
#include "trees/traversals/compress-inl.h"
#include "trees/traversals/rays/node_clip-inl.h"
#include "trees/traversals/rays/ray_traversal.h"

#include <bit>
#include <type_traits>

/// The steps of one ray that traversals share: into a node, into a leaf.
HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

using boxwood::HWY_NAMESPACE::intersect_block;

/// Each open node on a path leaves all but one of its children waiting; a whole node is stored
/// beyond them, and one reference below them ends a traversal.
template <class Node> constexpr std::size_t room_for(std::size_t depth) {
    return (depth + 2) * Node::width + 1;
}

/// Every child that is hit waits: in order the farthest first, each with its entry, else in none.
/// Gives the new top.
template <bool in_order, class Node, class Waiting>
HWY_INLINE Waiting* push_hit_children(const Node& node, const NodeClip<Node>& clip, float t_max,
                                      Waiting* top) {
    namespace hn = hwy::HWY_NAMESPACE;
    const NodeTag<Node> df;
    const hn::Rebind<std::uint32_t, decltype(df)> du;
    const auto far = hn::Set(df, t_max);
    [[maybe_unused]] alignas(64) float entries[Node::width];
    [[maybe_unused]] std::uint32_t bits = 0;
    for (std::size_t i = 0; i < Node::width; i += hn::Lanes(df)) {
        hn::Vec<decltype(df)> entry;
        const auto hit = clip.hits_of(node, i, far, entry);
        if constexpr (!in_order) {
            hn::StoreU(compressed(du, hn::LoadU(du, node.ref + i), hn::RebindMask(du, hit)), du,
                       top);
            top += hn::CountTrue(df, hit);
        } else {
            bits |= lane_bits(df, hit, i);
            if constexpr (in_register<Node>)
                push_sorted_eight(node.ref,
                                  hn::IfThenElseZero(hn::RebindMask(du, hit), keys_of(entry)), top);
            else
                hn::Store(entry, df, entries + i);
        }
    }
    if constexpr (in_order) {
        if constexpr (!in_register<Node>)
            push_sorted(node, bits, entries, top);
        top += std::popcount(bits);
    }
    return top;
}

/// One leaf; whether the ray needs no other. first: its first block.
template <class Node, RayKernel K, RayMode mode, bool Counted>
HWY_INLINE bool test_leaf(const RayBlock<Node>* first, std::uint32_t ref, const Ray<float>& ray,
                          RayState<K, mode, Counted>& state) {
    const RayBlock<Node>* block = first;
    const RayBlock<Node>* last = block + (Node::width > 8 && (ref & ray_refs::two));
    BlockHits<ray_lanes<Node>> hits;
    do {
        const std::uint32_t bits = intersect_block(std::type_identity<K>{}, state.per_ray, ray,
                                                   *block, state.t_max(), hits);
        if (!Counted && bits == 0)
            continue;
        state.tested(*block, bits, hits);
        if (state.done())
            return true;
    } while (++block <= last);
    return false;
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
