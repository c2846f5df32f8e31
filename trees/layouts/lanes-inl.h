// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_LANES_INL_H
#undef BOXWOOD_LANES_INL_H
#else
#define BOXWOOD_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "trees/layouts/wide.h"

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

/// The lanes of a block, or as many as a register holds: walks step through a block by
/// Lanes(LaneTag<Block>).
template <class Block>
using LaneTag = hwy::HWY_NAMESPACE::CappedTag<typename Block::Real, Block::width>;

/// The references of as many lanes.
template <class Block> using RefTag = hwy::HWY_NAMESPACE::Rebind<std::uint32_t, LaneTag<Block>>;

/// Lanes [i, i + Lanes(d)) of a plane: 0, 1, 2 are min x, y, z, and 3, 4, 5 max x, y, z. Unused
/// lanes are +inf in the first three and -inf in the others. Overloaded for every kind of block.
template <class Real, std::size_t W>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<LaneTag<BoxBlock<Real, W>>>
LoadPlane(const BoxBlock<Real, W>& block, std::size_t plane, std::size_t i) {
    return hwy::HWY_NAMESPACE::Load(LaneTag<BoxBlock<Real, W>>(), block.plane[plane] + i);
}

/// The references of lanes [i, i + Lanes(d)); 0 in unused lanes.
template <class Real, std::size_t W>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<RefTag<BoxBlock<Real, W>>>
LoadRefs(const BoxBlock<Real, W>& block, std::size_t i) {
    return hwy::HWY_NAMESPACE::Load(RefTag<BoxBlock<Real, W>>(), block.ref + i);
}

/// The lanes of a mask as bits: those of a part of a block that starts at lane `first`.
template <class D>
HWY_INLINE std::uint32_t MaskBits(D d, hwy::HWY_NAMESPACE::Mask<D> mask, std::size_t first) {
    std::uint8_t bytes[8] = {};
    hwy::HWY_NAMESPACE::StoreMaskBits(d, mask, bytes);
    return (std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8) << first;
}

/// Lanes [i, i + Lanes(d)) of a block against one box: true where the closed boxes overlap.
template <class Block>
HWY_INLINE hwy::HWY_NAMESPACE::Mask<LaneTag<Block>>
OverlapMask(const Block& block, std::size_t i, const Aabb<typename Block::Real>& box) {
    namespace hn = hwy::HWY_NAMESPACE;
    const LaneTag<Block> d;
    const auto x = hn::And(hn::Le(LoadPlane(block, 0, i), hn::Set(d, box.max.x)),
                           hn::Ge(LoadPlane(block, 3, i), hn::Set(d, box.min.x)));
    const auto y = hn::And(hn::Le(LoadPlane(block, 1, i), hn::Set(d, box.max.y)),
                           hn::Ge(LoadPlane(block, 4, i), hn::Set(d, box.min.y)));
    const auto z = hn::And(hn::Le(LoadPlane(block, 2, i), hn::Set(d, box.max.z)),
                           hn::Ge(LoadPlane(block, 5, i), hn::Set(d, box.min.z)));
    return hn::And(x, hn::And(y, z));
}

/// The lanes of a block that overlap a box, as bits.
template <class Block>
HWY_INLINE std::uint32_t OverlapBits(const Block& block, const Aabb<typename Block::Real>& box) {
    const LaneTag<Block> d;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < Block::width; i += hwy::HWY_NAMESPACE::Lanes(d))
        bits |= MaskBits(d, OverlapMask(block, i, box), i);
    return bits;
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
