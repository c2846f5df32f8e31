// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_NODE_CLIP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_NODE_CLIP_INL_H
#undef BOXWOOD_NODE_CLIP_INL_H
#else
#define BOXWOOD_NODE_CLIP_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/ray_box/fused_slabs.h"
#include "kernels/simd/ray_block-inl.h"
#include "trees/traversals/rays/ray_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

using boxwood::HWY_NAMESPACE::lane_bits;

template <class Node> using NodeTag = hwy::HWY_NAMESPACE::CappedTag<float, Node::width>;

/// Lanes [i, i + Lanes(d)) of the plane of this axis that stands `offset` bytes behind the first.
template <std::size_t W>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<NodeTag<RayNode<W>>>
plane_of(const RayNode<W>& node, int /*axis*/, std::size_t offset, std::size_t i) {
    const auto* planes = reinterpret_cast<const std::byte*>(node.plane);
    return hwy::HWY_NAMESPACE::Load(NodeTag<RayNode<W>>(),
                                    reinterpret_cast<const float*>(planes + offset) + i);
}
/// `decode` of QuantisedBlock, operation for operation.
HWY_INLINE hwy::HWY_NAMESPACE::Vec<NodeTag<QuantisedBlock>>
plane_of(const QuantisedBlock& node, int axis, std::size_t offset, std::size_t i) {
    namespace hn = hwy::HWY_NAMESPACE;
    const NodeTag<QuantisedBlock> d;
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    const hn::Rebind<std::int32_t, decltype(d)> d32;
    const auto steps =
        hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d8, node.plane[0] + offset + i)));
    return hn::Add(hn::Set(d, node.bounds.min[axis]), hn::Mul(steps, hn::Set(d, node.scale[axis])));
}

/// The lanes that a ray hits, without those that are not in use.
template <std::size_t W, class M> HWY_INLINE M used_of(const RayNode<W>&, M hits, std::size_t) {
    return hits; // the empty box is never hit
}
template <class M> HWY_INLINE M used_of(const QuantisedBlock& node, M hits, std::size_t i) {
    namespace hn = hwy::HWY_NAMESPACE;
    return hn::And(hits,
                   hn::FirstN(NodeTag<QuantisedBlock>(), node.count > i ? node.count - i : 0));
}

struct WaitingNode {
    std::uint32_t ref;
    float entry;
};
static_assert(sizeof(WaitingNode) == 8);

/// FusedSlabs of what stands for several rays: its exit has another line than its entry.
struct FrontSlabs {
    Float4 entry_rdir, entry_shift, exit_rdir, exit_shift;
};

/// FusedSlabs in registers.
template <class Node> class NodeClip {
    using D = NodeTag<Node>;
    using V = hwy::HWY_NAMESPACE::Vec<D>;
    using M = hwy::HWY_NAMESPACE::Mask<D>;

  public:
    HWY_INLINE NodeClip(const FusedSlabs& slabs, float t_min)
        : NodeClip(slabs.rdir, slabs.entry_shift, slabs.exit_shift, t_min) {}
    HWY_INLINE NodeClip(const FrontSlabs& slabs, float t_min)
        : NodeClip(slabs.entry_rdir, slabs.entry_shift, slabs.exit_shift, t_min) {
        rx0_ = everywhere(slabs.exit_rdir[0]);
        rx1_ = everywhere(slabs.exit_rdir[1]);
        rx2_ = everywhere(slabs.exit_rdir[2]);
    }

    /// `clip` for the lanes from i on: which are hit, and where each is entered.
    HWY_INLINE M hits_of(const Node& node, std::size_t i, V t_max, V& entry) const {
        namespace hn = hwy::HWY_NAMESPACE;
        entry = hn::Max(hn::Max(hn::MulSub(plane_of(node, 0, near0_, i), re0_, se0_),
                                hn::MulSub(plane_of(node, 1, near1_, i), re1_, se1_)),
                        hn::Max(hn::MulSub(plane_of(node, 2, near2_, i), re2_, se2_), t_min_));
        const V exit = hn::Min(
            hn::Min(hn::MulSub(plane_of(node, 0, 3 * plane - near0_, i), rx0_, sx0_),
                    hn::MulSub(plane_of(node, 1, 5 * plane - near1_, i), rx1_, sx1_)),
            hn::Min(hn::MulSub(plane_of(node, 2, 7 * plane - near2_, i), rx2_, sx2_), t_max));
        return used_of(node, hn::Le(entry, exit), i);
    }

  private:
    static constexpr std::size_t plane = sizeof(Node::plane) / 6; ///< bytes

    HWY_INLINE NodeClip(Float4 rdir, Float4 entry_shift, Float4 exit_shift, float t_min)
        : re0_(everywhere(rdir[0])), re1_(everywhere(rdir[1])), re2_(everywhere(rdir[2])),
          se0_(everywhere(entry_shift[0])), se1_(everywhere(entry_shift[1])),
          se2_(everywhere(entry_shift[2])), sx0_(everywhere(exit_shift[0])),
          sx1_(everywhere(exit_shift[1])), sx2_(everywhere(exit_shift[2])),
          t_min_(everywhere(t_min)), rx0_(re0_), rx1_(re1_), rx2_(re2_), near0_(near(rdir, 0)),
          near1_(near(rdir, 1)), near2_(near(rdir, 2)) {}

    static HWY_INLINE V everywhere(float x) { return hwy::HWY_NAMESPACE::Set(D(), x); }
    static HWY_INLINE std::size_t near(Float4 rdir, std::size_t k) {
        return plane * (k + 3 * (std::bit_cast<std::uint32_t>(rdir[k]) >> 31));
    }

    const V re0_, re1_, re2_, se0_, se1_, se2_, sx0_, sx1_, sx2_, t_min_;
    V rx0_, rx1_, rx2_;                       ///< of one ray the same as of its entry
    const std::size_t near0_, near1_, near2_; ///< of `plane_of`; the far planes are the others
};

/// The children that are hit: the farthest first on the stack, the nearest on top of it.
template <class Node>
HWY_INLINE void push_sorted(const Node& node, std::uint32_t bits, const float* entry,
                            WaitingNode* stack) {
    std::size_t top = 0;
    for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
        const WaitingNode other{node.ref[lane], entry[lane]};
        std::size_t place = top++;
        for (; place > 0 && stack[place - 1].entry < other.entry; --place)
            stack[place] = stack[place - 1];
        stack[place] = other;
    }
}

/// Whether registers hold eight entries and sort them.
#ifndef BOXWOOD_SORTS_EIGHT
#define BOXWOOD_SORTS_EIGHT (HWY_TARGET != HWY_SCALAR && HWY_TARGET <= HWY_AVX2)
#endif

#if BOXWOOD_SORTS_EIGHT
/// The entries (>= 0) of eight lanes as numbers that are all different: rounded down to multiples
/// of eight ulp, with the lane below.
template <class V> HWY_INLINE auto keys_of(V entry) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<std::uint32_t, 8> du;
    return hn::Or(hn::AndNot(hn::Set(du, 7u), hn::BitCast(du, hn::Abs(entry))), hn::Iota(du, 0));
}

/// In every lane the smallest key of the lanes that are hit, of which there is at least one.
template <class V, class M> HWY_INLINE V min_key(V keys, M hit) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<std::uint32_t, 8> du;
    V key = hn::IfThenElse(hit, keys, hn::Set(du, ~std::uint32_t{0}));
    key = hn::Min(key, hn::ConcatLowerUpper(du, key, key));
    key = hn::Min(key, hn::Shuffle1032(key));
    return hn::Min(key, hn::Shuffle2301(key));
}

/// The greatest first: sorts four and four, then merges them. All steps but one stay within four
/// lanes: from one half of a register to the other a number takes three to eight times as long.
template <class V> HWY_INLINE V in_descending_order(V keys) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<std::uint32_t, 8> du;
    const hn::CappedTag<std::uint64_t, 4> pairs;
    const auto every_second_takes_less = [&](V other) HWY_ATTR {
        keys = hn::OddEven(hn::Min(keys, other), hn::Max(keys, other));
    };
    const auto every_second_pair_takes_less = [&](V other) HWY_ATTR {
        keys = hn::BitCast(du, hn::OddEven(hn::BitCast(pairs, hn::Min(keys, other)),
                                           hn::BitCast(pairs, hn::Max(keys, other))));
    };
    every_second_pair_takes_less(hn::Shuffle1032(keys));
    every_second_takes_less(hn::Shuffle2301(keys));
    every_second_pair_takes_less(hn::InterleaveLower(du, keys, hn::Shuffle1032(keys)));
    const V other = hn::Shuffle0123(hn::ConcatLowerUpper(du, keys, keys));
    keys = hn::ConcatUpperLower(du, hn::Min(keys, other), hn::Max(keys, other));
    every_second_pair_takes_less(hn::Shuffle1032(keys));
    every_second_takes_less(hn::Shuffle2301(keys));
    return keys;
}

/// As push_sorted for the keys of eight lanes, without a branch. Those that are not to be on the
/// stack are 0, and written above its top.
template <class V>
HWY_INLINE void push_sorted_eight(const std::uint32_t* refs, V keys, WaitingNode* stack) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<std::uint32_t, 8> du;
    const V lanes = hn::Set(du, 7u);
    keys = in_descending_order(keys);
    const V sorted =
        hn::TableLookupLanes(hn::LoadU(du, refs), hn::IndicesFromVec(du, hn::And(keys, lanes)));
    hn::StoreInterleaved2(sorted, hn::AndNot(lanes, keys), du,
                          reinterpret_cast<std::uint32_t*>(stack));
}
#endif

/// Whether eight entries stay in one register.
template <class Node> inline constexpr bool in_register = BOXWOOD_SORTS_EIGHT&& Node::width == 8;

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
