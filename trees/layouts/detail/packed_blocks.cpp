// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/layouts/detail/packed_blocks.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/layouts/detail/packed_blocks.h"

#include <algorithm>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Fills a block with up to sixteen boxes from `first` on; returns their bounds.
Box fill_any(const PackedSource& boxes, std::size_t first, PackedBlock& block) {
    const std::size_t count = PackedLayout::lanes_used(first, boxes.n);
    constexpr float inf = std::numeric_limits<float>::infinity();
    Box bounds;
    for (std::size_t lane = 0; lane < PackedBlock::width; ++lane) {
        const Box box =
            lane < count ? boxes[first + lane] : Box{{inf, inf, inf}, {-inf, -inf, -inf}};
        for (int axis = 0; axis < 3; ++axis) {
            block.plane[axis][lane] = box.min[axis];
            block.plane[3 + axis][lane] = box.max[axis];
        }
        bounds.extend(box);
    }
    return bounds;
}

#if HWY_TARGET == HWY_SCALAR
Box fill_whole(const PackedSource& boxes, std::size_t first, PackedBlock& block) {
    return fill_any(boxes, first, block);
}
#else
constexpr hn::FixedTag<float, 4> d4;
constexpr hn::Repartition<double, decltype(d4)> d2;

/// Four boxes at a time, each as two overlapping quads: min and max.x, min.z and max.
HWY_INLINE Box fill_whole(const PackedSource& boxes, std::size_t first, PackedBlock& block) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    auto low = hn::Set(d4, inf), high = hn::Set(d4, -inf);
    for (std::size_t lane = 0; lane < PackedBlock::width; lane += 4) {
        const auto lower = [&](std::size_t i) HWY_ATTR {
            const auto quad = hn::LoadU(d4, &boxes[first + lane + i].min.x);
            low = hn::Min(low, quad);
            return quad;
        };
        const auto upper = [&](std::size_t i) HWY_ATTR {
            const auto quad = hn::LoadU(d4, &boxes[first + lane + i].min.z);
            high = hn::Max(high, quad);
            return quad;
        };
        const auto put = [&](std::size_t plane, auto quad) HWY_ATTR {
            hn::Store(hn::BitCast(d4, quad), d4, block.plane[plane] + lane);
        };
        const auto pairs = [](auto v) HWY_ATTR { return hn::BitCast(d2, v); };
        const auto a = lower(0), b = lower(1), c = lower(2), d = lower(3);
        const auto xy0 = pairs(hn::InterleaveLower(d4, a, b)),
                   xy1 = pairs(hn::InterleaveLower(d4, c, d));
        put(0, hn::InterleaveLower(d2, xy0, xy1));
        put(1, hn::InterleaveUpper(d2, xy0, xy1));
        const auto zx0 = pairs(hn::InterleaveUpper(d4, a, b)),
                   zx1 = pairs(hn::InterleaveUpper(d4, c, d));
        put(2, hn::InterleaveLower(d2, zx0, zx1));
        put(3, hn::InterleaveUpper(d2, zx0, zx1));
        const auto e = upper(0), f = upper(1), g = upper(2), h = upper(3);
        const auto yz0 = pairs(hn::InterleaveUpper(d4, e, f)),
                   yz1 = pairs(hn::InterleaveUpper(d4, g, h));
        put(4, hn::InterleaveLower(d2, yz0, yz1));
        put(5, hn::InterleaveUpper(d2, yz0, yz1));
    }
    alignas(16) float min[4], max[4];
    hn::Store(low, d4, min);
    hn::Store(high, d4, max);
    return {{min[0], min[1], min[2]}, {max[1], max[2], max[3]}};
}
#endif

void fill_packed(const PackedSource& boxes, std::size_t begin, std::size_t end,
                 PackedBlock* HWY_RESTRICT blocks, Box* HWY_RESTRICT bounds) {
    constexpr std::size_t w = PackedBlock::width, ahead = 2 * w;
    const std::size_t whole = std::min(end, boxes.n / w);
    for (std::size_t b = begin; b < whole; ++b) {
        if (boxes.index) // the boxes lie anywhere, a quarter of them across a cache line's end
            for (std::size_t i = b * w + ahead; i < std::min((b + 1) * w + ahead, boxes.n); ++i) {
                const Box& box = boxes[i];
                __builtin_prefetch(&box.min.x);
                __builtin_prefetch(&box.max.z);
            }
        bounds[b] = fill_whole(boxes, b * w, blocks[b]);
    }
    for (std::size_t b = std::max(begin, whole); b < end; ++b)
        bounds[b] = fill_any(boxes, b * w, blocks[b]);
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(fill_packed);

void fill_packed(const PackedSource& boxes, std::size_t begin, std::size_t end, PackedBlock* blocks,
                 Box* bounds) {
    HWY_DYNAMIC_DISPATCH(fill_packed)(boxes, begin, end, blocks, bounds);
}

} // namespace boxwood::detail
#endif
