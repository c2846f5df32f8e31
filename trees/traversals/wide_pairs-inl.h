// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_WIDE_PAIRS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_WIDE_PAIRS_INL_H
#undef BOXWOOD_WIDE_PAIRS_INL_H
#else
#define BOXWOOD_WIDE_PAIRS_INL_H
#endif

#include <hwy/highway.h>

#include "trees/layouts/detail/lanes-inl.h"
#include "trees/traversals/compress-inl.h"
#include "trees/traversals/pair_traversal.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// How a fixed reference and those of the overlapping lanes become pairs.
enum class Order { fixed_first, fixed_second, lower_first };

/// Appends a pair for each lane of the block that overlaps the box; returns how many. Stores whole
/// registers: up to Block::width pairs beyond the last are overwritten.
template <Order order, class Block>
HWY_INLINE std::size_t append(const Block& block, const Aabb<typename Block::Real>& box,
                              std::uint32_t fixed, Pair* to) {
    namespace hn = hwy::HWY_NAMESPACE;
    const RefTag<Block> du;
    std::size_t n = 0;
    const auto f = hn::Set(du, fixed);
    for (std::size_t i = 0; i < Block::width; i += hn::Lanes(du)) {
        const auto hits = ref_mask<Block>(overlap_mask(block, i, box));
        const auto refs = compressed(du, load_refs(block, i), hits);
        const auto first = order == Order::fixed_first    ? f
                           : order == Order::fixed_second ? refs
                                                          : hn::Min(f, refs);
        const auto second = order == Order::fixed_first    ? refs
                            : order == Order::fixed_second ? f
                                                           : hn::Max(f, refs);
        hn::StoreInterleaved2(first, second, du, reinterpret_cast<std::uint32_t*>(to + n));
        n += hn::CountTrue(du, hits);
    }
    return n;
}

/// Appends all overlapping pairs of lanes of two blocks: those of `a` that reach into `b` against
/// the lanes of `b`, or the other way round, whichever are fewer.
template <bool LowerFirst, bool Counted, class A, class B>
HWY_INLINE std::size_t append_all(PairTraversal& state, const A& a, const B& b, Pair* to) {
    std::uint32_t mask_a = overlap_bits(a, b.bounds);
    std::uint32_t mask_b = mask_a ? overlap_bits(b, a.bounds) : 0;
    const int few = std::min(std::popcount(mask_a), std::popcount(mask_b));
    state.count<Counted>(A::width * static_cast<unsigned>((mask_a ? 2 : 1) + few));
    std::size_t n = 0;
    if (std::popcount(mask_a) <= std::popcount(mask_b)) {
        for (; mask_a; mask_a &= mask_a - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(mask_a));
            n += append < LowerFirst ? Order::lower_first
                                     : Order::fixed_first > (b, a.lane(lane), a.ref[lane], to + n);
        }
    } else {
        for (; mask_b; mask_b &= mask_b - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(mask_b));
            n += append < LowerFirst ? Order::lower_first
                                     : Order::fixed_second > (a, b.lane(lane), b.ref[lane], to + n);
        }
    }
    return n;
}

/// The pairs of overlapping lanes within one block, each once; of a leaf the lower item first.
template <bool Leaf, bool Counted, class Block>
HWY_INLINE std::size_t append_self(PairTraversal& state, const Block& block, Pair* const start) {
    state.count<Counted>(Block::width * (block.count - 1));
    Pair* to = start;
    for (std::uint32_t i = 0; i + 1 < block.count; ++i) {
        std::uint32_t bits = overlap_bits(block, block.lane(i)) & (~std::uint32_t{1} << i);
        for (; bits; bits &= bits - 1) {
            const std::uint32_t a = block.ref[i], b = block.ref[std::countr_zero(bits)];
            *to++ = Leaf && b < a ? Pair{b, a} : Pair{a, b};
        }
    }
    return static_cast<std::size_t>(to - start);
}

/// The traversal below the pairs of nodes on the stack. A pair of a leaf and an inner node opens
/// the inner one, so the stack holds at most width^2 pairs per level of the two trees.
template <class L, bool Self, bool Counted>
void traverse_pairs(PairTraversal& state, const L& tree_a, const L& tree_b) {
    Pair nodes{};
    while (state.next(nodes)) {
        const bool leaf_a = L::is_leaf(nodes.a), leaf_b = L::is_leaf(nodes.b);
        if (Self && nodes.a == nodes.b) {
            if (leaf_a) {
                state.emitted(
                    append_self<true, Counted>(state, tree_a.leaf(nodes.a), state.emit_to()));
                continue;
            }
            const auto& block = tree_a.block(nodes.a);
            Pair* to = state.push_to();
            for (std::uint32_t i = block.count; i-- > 0;)
                *to++ = {block.ref[i], block.ref[i]};
            state.pushed(block.count);
            state.pushed(append_self<false, Counted>(state, block, state.push_to()));
        } else if (leaf_a && leaf_b) {
            state.emitted(append_all<Self, Counted>(state, tree_a.leaf(nodes.a),
                                                    tree_b.leaf(nodes.b), state.emit_to()));
        } else if (leaf_a) {
            state.count<Counted>(L::width);
            state.pushed(append<Order::fixed_first>(
                tree_b.block(nodes.b), tree_a.leaf(nodes.a).bounds, nodes.a, state.push_to()));
        } else if (leaf_b) {
            state.count<Counted>(L::width);
            state.pushed(append<Order::fixed_second>(
                tree_a.block(nodes.a), tree_b.leaf(nodes.b).bounds, nodes.b, state.push_to()));
        } else {
            state.pushed(append_all<false, Counted>(state, tree_a.block(nodes.a),
                                                    tree_b.block(nodes.b), state.push_to()));
        }
    }
}

/// self: `b` is `a`.
template <class L>
void any_pairs(PairTraversal& state, const L& a, const L& b, bool self, bool counted) {
    if (self)
        counted ? traverse_pairs<L, true, true>(state, a, b)
                : traverse_pairs<L, true, false>(state, a, b);
    else
        counted ? traverse_pairs<L, false, true>(state, a, b)
                : traverse_pairs<L, false, false>(state, a, b);
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
