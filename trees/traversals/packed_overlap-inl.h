// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_PACKED_OVERLAP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_PACKED_OVERLAP_INL_H
#undef BOXWOOD_PACKED_OVERLAP_INL_H
#else
#define BOXWOOD_PACKED_OVERLAP_INL_H
#endif

#include <hwy/highway.h>

#include "trees/traversals/compress-inl.h"
#include "trees/traversals/packed_traversal.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, PackedBlock::width> df;
constexpr hn::RebindToUnsigned<decltype(df)> du;
constexpr std::size_t lanes = hn::MaxLanes(df);

using F = hn::Vec<decltype(df)>;
using U = hn::Vec<decltype(du)>;
using M = hn::Mask<decltype(df)>;

/// One box in every lane.
struct OneBox {
    F min_x, min_y, min_z, max_x, max_y, max_z;

    explicit OneBox(const Box& box)
        : min_x(hn::Set(df, box.min.x)), min_y(hn::Set(df, box.min.y)),
          min_z(hn::Set(df, box.min.z)), max_x(hn::Set(df, box.max.x)),
          max_y(hn::Set(df, box.max.y)), max_z(hn::Set(df, box.max.z)) {}
};

/// Lanes [i, i + lanes) of a block that overlap the box.
HWY_INLINE M overlap_lanes(const PackedBlock& block, std::size_t i, const OneBox& box) {
    const auto plane = [&](std::size_t p) HWY_ATTR { return hn::Load(df, block.plane[p] + i); };
    return hn::And(hn::And(hn::And(hn::Ge(box.max_x, plane(0)), hn::Le(box.min_x, plane(3))),
                           hn::And(hn::Ge(box.max_y, plane(1)), hn::Le(box.min_y, plane(4)))),
                   hn::And(hn::Ge(box.max_z, plane(2)), hn::Le(box.min_z, plane(5))));
}

/// Lanes [i, i + lanes) of a block that overlap lane `lane` of another.
HWY_INLINE M overlap_lanes(const PackedBlock& block, std::size_t i, const PackedBlock& other,
                           std::size_t lane) {
    const auto plane = [&](std::size_t p) HWY_ATTR { return hn::Load(df, block.plane[p] + i); };
    const auto one = [&](std::size_t p) HWY_ATTR { return hn::Set(df, other.plane[p][lane]); };
    return hn::And(hn::And(hn::And(hn::Le(plane(0), one(3)), hn::Ge(plane(3), one(0))),
                           hn::And(hn::Le(plane(1), one(4)), hn::Ge(plane(4), one(1)))),
                   hn::And(hn::Le(plane(2), one(5)), hn::Ge(plane(5), one(2))));
}

/// A block and its items twice in a row: sixteen lanes from lane k on are the block turned by k.
struct TwiceSixteen {
    alignas(64) float plane[6][2 * PackedBlock::width];
    alignas(64) std::uint32_t item[2 * PackedBlock::width];

    void hold(const PackedBlock& block, const std::uint32_t* items) {
        for (std::size_t i = 0; i < PackedBlock::width; i += lanes)
            for (const std::size_t at : {i, i + PackedBlock::width}) {
                for (std::size_t p = 0; p < 6; ++p)
                    hn::Store(hn::Load(df, block.plane[p] + i), df, plane[p] + at);
                hn::Store(hn::Load(du, items + i), du, item + at);
            }
    }
    /// Of lanes [i, i + lanes) those that overlap the lane k further on.
    HWY_INLINE M overlap(std::size_t i, std::size_t k) const {
        const auto lane = [&](std::size_t p) HWY_ATTR { return hn::Load(df, plane[p] + i); };
        const auto turned = [&](std::size_t p) HWY_ATTR { return hn::LoadU(df, plane[p] + i + k); };
        return hn::And(hn::And(hn::And(hn::Le(lane(0), turned(3)), hn::Ge(lane(3), turned(0))),
                               hn::And(hn::Le(lane(1), turned(4)), hn::Ge(lane(4), turned(1)))),
                       hn::And(hn::Le(lane(2), turned(5)), hn::Ge(lane(5), turned(2))));
    }
};

/// Writes the lanes of `many` that hit to `a`, `one` beside each to `b`, and whatever up to a whole
/// register beyond; returns how many there are.
HWY_INLINE std::size_t put(M hits, U many, const std::uint32_t* one, std::uint32_t* a,
                           std::uint32_t* b) {
    const auto mask = hn::RebindMask(du, hits);
    hn::StoreU(hn::Set(du, *one), du, b);
    hn::StoreU(compressed(du, many, mask), du, a);
    return hn::CountTrue(du, mask);
}

/// The lanes of a block that hit, a register at a time.
struct Hits {
    M of[PackedBlock::width / lanes];

    template <class Test> HWY_INLINE explicit Hits(const Test& test) {
        for (std::size_t i = 0; i < PackedBlock::width; i += lanes)
            of[i / lanes] = test(i);
    }
    HWY_INLINE M operator[](std::size_t i) const { return of[i / lanes]; }
};

/// Appends to `out` the lanes (numbered through the level: 16 block + lane) of the listed blocks
/// that overlap the box.
template <bool Counted>
HWY_INLINE void refine(const PackedBlock* level, const PackedList& list, std::size_t first,
                       const OneBox& box, PackedList& out, Work* work) {
    constexpr std::size_t w = PackedBlock::width;
    std::uint32_t* to = out.reserve((list.size() - first) * w + w);
    const std::uint32_t* const begin = to;
    const auto iota = hn::Iota(du, 0u);
    for (std::size_t j = first; j < list.size(); ++j) {
        const std::uint32_t b = list[j];
        for (std::size_t i = 0; i < w; i += lanes) {
            const auto hits = hn::RebindMask(du, overlap_lanes(level[b], i, box));
            const auto number = hn::Add(iota, hn::Set(du, static_cast<std::uint32_t>(b * w + i)));
            hn::StoreU(compressed(du, number, hits), du, to);
            to += hn::CountTrue(du, hits);
        }
    }
    out.grow(static_cast<std::size_t>(to - begin));
    if constexpr (Counted) {
        work->node_visits += list.size() - first;
        work->box_tests += w * (list.size() - first);
        work->stack_max = std::max<std::uint64_t>(work->stack_max, out.size());
    }
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
