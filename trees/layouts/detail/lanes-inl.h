// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_LANES_INL_H
#undef BOXWOOD_LANES_INL_H
#else
#define BOXWOOD_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "trees/layouts/packed.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"

#include <cstdint>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// The lanes of a block, or as many as a register holds: traversals step through a block by
/// Lanes(LaneTag<Block>).
template <class Block>
using LaneTag = hwy::HWY_NAMESPACE::CappedTag<typename Block::Real, Block::width>;

/// The references of as many lanes.
template <class Block> using RefTag = hwy::HWY_NAMESPACE::Rebind<std::uint32_t, LaneTag<Block>>;

/// Lanes [i, i + Lanes(d)) of a plane: 0, 1, 2 are min x, y, z, and 3, 4, 5 max x, y, z. Unused
/// lanes are +inf in the first three and -inf in the others. Overloaded for every kind of block.
template <class Real, std::size_t W>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<LaneTag<BoxBlock<Real, W>>>
load_plane(const BoxBlock<Real, W>& block, std::size_t plane, std::size_t i) {
    return hwy::HWY_NAMESPACE::Load(LaneTag<BoxBlock<Real, W>>(), block.plane[plane] + i);
}

/// The references of lanes [i, i + Lanes(d)); 0 in unused lanes.
template <class Real, std::size_t W>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<RefTag<BoxBlock<Real, W>>>
load_refs(const BoxBlock<Real, W>& block, std::size_t i) {
    return hwy::HWY_NAMESPACE::Load(RefTag<BoxBlock<Real, W>>(), block.ref + i);
}

/// The lanes from `i` on that are in use.
template <class D, class Block>
HWY_INLINE hwy::HWY_NAMESPACE::Mask<D> used_lanes(D d, const Block& block, std::size_t i) {
    return hwy::HWY_NAMESPACE::FirstN(d, block.count > i ? block.count - i : 0);
}

/// `decode` of QuantisedBlock, operation for operation.
HWY_INLINE hwy::HWY_NAMESPACE::Vec<LaneTag<QuantisedBlock>>
load_plane(const QuantisedBlock& block, std::size_t plane, std::size_t i) {
    namespace hn = hwy::HWY_NAMESPACE;
    const LaneTag<QuantisedBlock> d;
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    const hn::Rebind<std::int32_t, decltype(d)> d32;
    const bool upper = plane >= 3;
    const std::size_t axis = upper ? plane - 3 : plane;
    const auto steps = hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d8, block.plane[plane] + i)));
    const auto offset = hn::Mul(steps, hn::Set(d, block.scale[axis]));
    const auto decoded = hn::Add(hn::Set(d, block.bounds.min[static_cast<int>(axis)]), offset);
    return hn::IfThenElse(used_lanes(d, block, i), decoded,
                          hn::Set(d, upper ? -Box::inf : Box::inf));
}
HWY_INLINE hwy::HWY_NAMESPACE::Vec<RefTag<QuantisedBlock>> load_refs(const QuantisedBlock& block,
                                                                     std::size_t i) {
    return hwy::HWY_NAMESPACE::Load(RefTag<QuantisedBlock>(), block.ref + i);
}

HWY_INLINE hwy::HWY_NAMESPACE::Vec<LaneTag<PackedLeaf>>
load_plane(const PackedLeaf& leaf, std::size_t plane, std::size_t i) {
    namespace hn = hwy::HWY_NAMESPACE;
    const LaneTag<PackedLeaf> d;
    const RefTag<PackedLeaf> du;
    const auto bits = hn::LoadU(du, leaf.plane + plane * leaf.count + i);
    return hn::IfThenElse(used_lanes(d, leaf, i), hn::BitCast(d, bits),
                          hn::Set(d, plane >= 3 ? -Box::inf : Box::inf));
}
HWY_INLINE hwy::HWY_NAMESPACE::Vec<RefTag<PackedLeaf>> load_refs(const PackedLeaf& leaf,
                                                                 std::size_t i) {
    const RefTag<PackedLeaf> du;
    return hwy::HWY_NAMESPACE::IfThenElseZero(used_lanes(du, leaf, i),
                                              hwy::HWY_NAMESPACE::LoadU(du, leaf.ref + i));
}

/// A mask of lanes as one of their references.
template <class Block>
HWY_INLINE hwy::HWY_NAMESPACE::Mask<RefTag<Block>>
ref_mask(hwy::HWY_NAMESPACE::Mask<LaneTag<Block>> mask) {
    namespace hn = hwy::HWY_NAMESPACE;
    if constexpr (std::is_same_v<typename Block::Real, float>) {
        return hn::RebindMask(RefTag<Block>(), mask);
    } else {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(LaneTag<Block>(), mask, bytes);
        return hn::LoadMaskBits(RefTag<Block>(), bytes);
    }
}

HWY_INLINE hwy::HWY_NAMESPACE::Vec<LaneTag<PackedView>>
load_plane(const PackedView& block, std::size_t plane, std::size_t i) {
    return hwy::HWY_NAMESPACE::Load(LaneTag<PackedView>(), block.planes->plane[plane] + i);
}
HWY_INLINE hwy::HWY_NAMESPACE::Vec<RefTag<PackedView>> load_refs(const PackedView& block,
                                                                 std::size_t i) {
    namespace hn = hwy::HWY_NAMESPACE;
    const RefTag<PackedView> d;
    return block.ref.items ? hn::Load(d, block.ref.items + i)
                           : hn::Iota(d, block.ref.first + static_cast<std::uint32_t>(i));
}

/// The lanes of a mask as bits: those of a part of a block that starts at lane `first`.
template <class D>
HWY_INLINE std::uint32_t mask_bits(D d, hwy::HWY_NAMESPACE::Mask<D> mask, std::size_t first) {
    std::uint8_t bytes[8] = {};
    hwy::HWY_NAMESPACE::StoreMaskBits(d, mask, bytes);
    return (std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8) << first;
}

/// Lanes [i, i + Lanes(d)) of a block against one box: true where the closed boxes overlap.
template <class Block>
HWY_INLINE hwy::HWY_NAMESPACE::Mask<LaneTag<Block>>
overlap_mask(const Block& block, std::size_t i, const Aabb<typename Block::Real>& box) {
    namespace hn = hwy::HWY_NAMESPACE;
    const LaneTag<Block> d;
    const auto x = hn::And(hn::Le(load_plane(block, 0, i), hn::Set(d, box.max.x)),
                           hn::Ge(load_plane(block, 3, i), hn::Set(d, box.min.x)));
    const auto y = hn::And(hn::Le(load_plane(block, 1, i), hn::Set(d, box.max.y)),
                           hn::Ge(load_plane(block, 4, i), hn::Set(d, box.min.y)));
    const auto z = hn::And(hn::Le(load_plane(block, 2, i), hn::Set(d, box.max.z)),
                           hn::Ge(load_plane(block, 5, i), hn::Set(d, box.min.z)));
    return hn::And(x, hn::And(y, z));
}

/// The lanes of a block that overlap a box, as bits.
template <class Block>
HWY_INLINE std::uint32_t overlap_bits(const Block& block, const Aabb<typename Block::Real>& box) {
    const LaneTag<Block> d;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < Block::width; i += hwy::HWY_NAMESPACE::Lanes(d))
        bits |= mask_bits(d, overlap_mask(block, i, box), i);
    return bits;
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
