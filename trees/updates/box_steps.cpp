// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/updates/box_steps.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/updates/box_steps.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 16> df;
constexpr std::size_t lanes = hn::MaxLanes(df);
constexpr std::size_t block_floats = 6 * follow_block;

/// False also for some valid boxes, of huge coordinates.
bool AllValid(Boxes boxes) {
    const float* const row = reinterpret_cast<const float*>(boxes.data());
    const std::size_t n = 6 * boxes.size();
    // In three registers every place has the same coordinate each time; 1 where that is a min.
    alignas(64) float is_min[3 * lanes];
    for (std::size_t i = 0; i < 3 * lanes; ++i)
        is_min[i] = i % 6 < 3 ? 1.f : 0.f;
    auto bad = hn::Zero(df); // 0 while all is finite and min <= max; else negative or NaN
    std::size_t done = 0;
    if constexpr (lanes >= 4) {
        const auto check = [&](std::size_t at, std::size_t third) HWY_ATTR {
            const auto v = hn::LoadU(df, row + at), w = hn::LoadU(df, row + at + 3);
            const auto min = hn::Load(df, is_min + third * lanes);
            const auto extent = hn::Mul(hn::Sub(w, v), min);
            bad = hn::Add(bad, hn::Add(hn::Min(extent, hn::Zero(df)), hn::Sub(v, v)));
        };
        for (; done + 3 * lanes + 3 <= n; done += 3 * lanes) {
            check(done, 0);
            check(done + lanes, 1);
            check(done + 2 * lanes, 2);
        }
    }
    alignas(64) float sums[lanes];
    hn::Store(bad, df, sums);
    bool valid = std::ranges::all_of(sums, [](float sum) { return sum == 0; });
    for (std::size_t i = done / 6; i < boxes.size(); ++i)
        valid = valid && boxes[i].is_valid();
    return valid;
}

bool AreAll(std::span<const std::uint32_t> items) {
    constexpr hn::RebindToUnsigned<decltype(df)> du;
    auto differ = hn::Zero(du), number = hn::Iota(du, 0u);
    std::size_t i = 0;
    for (; i + lanes <= items.size(); i += lanes) {
        differ = hn::Or(differ, hn::Xor(hn::LoadU(du, items.data() + i), number));
        number = hn::Add(number, hn::Set(du, static_cast<std::uint32_t>(lanes)));
    }
    bool all = hn::AllTrue(du, hn::Eq(differ, hn::Zero(du)));
    for (; i < items.size(); ++i)
        all = all && items[i] == i;
    return all;
}

std::size_t FollowBlocks(Boxes now, Box* HWY_RESTRICT kept, std::size_t begin, std::size_t end,
                         float most, float* HWY_RESTRICT steps, std::uint32_t* HWY_RESTRICT far) {
    std::size_t n_far = 0;
    for (std::size_t b = begin; b < end; ++b) {
        const std::size_t first = b * follow_block,
                          count = std::min(follow_block, now.size() - first);
        float step = 0;
        const bool whole = count == follow_block;
        if (whole) {
            const float* const from = reinterpret_cast<const float*>(&now[first]);
            const float* const before = reinterpret_cast<const float*>(kept + first);
            auto all = hn::Zero(df);
            for (std::size_t i = 0; i < block_floats; i += lanes) {
                const auto x = hn::LoadU(df, from + i), y = hn::LoadU(df, before + i);
                // Infinities that are the same, of an absent box, have gone nowhere.
                const auto d = hn::Max(hn::Abs(hn::Sub(x, y)), hn::Set(df, FLT_MIN));
                all = hn::Max(all, hn::IfThenElseZero(hn::Ne(x, y), d));
            }
            step = hn::GetLane(hn::MaxOfLanes(df, all));
        } else {
            for (std::size_t i = first; i < first + count; ++i)
                step = std::max(step, box_step(now[i], kept[i]));
        }
        steps[b] = step;
        if (!(step <= most)) {
            far[n_far++] = static_cast<std::uint32_t>(b);
        } else if (whole) {
            const float* const from = reinterpret_cast<const float*>(&now[first]);
            float* const to = reinterpret_cast<float*>(kept + first);
            for (std::size_t i = 0; i < block_floats; i += lanes)
                hn::StoreU(hn::LoadU(df, from + i), df, to + i);
        } else {
            std::copy_n(&now[first], count, kept + first);
        }
    }
    return n_far;
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(AllValid);
HWY_EXPORT(AreAll);
HWY_EXPORT(FollowBlocks);

void require_present_or_absent(std::uint32_t item, const Box& box) {
    if (!box.is_valid() && !is_absent(box))
        throw InvalidBox(item, "a NaN, an infinity or min > max; give finite corners, min <= max, "
                               "or Box{} for an item that is absent");
}

void require_present_or_absent(Boxes boxes) {
    if (boxes.size() > max_items)
        require_valid(boxes);
    if (HWY_DYNAMIC_DISPATCH(AllValid)(boxes))
        return;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        require_present_or_absent(static_cast<std::uint32_t>(i), boxes[i]);
}

bool are_all(std::span<const std::uint32_t> items) { return HWY_DYNAMIC_DISPATCH(AreAll)(items); }

float box_step(const Box& now, const Box& before) {
    float step = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const auto& [x, y] : {std::pair{now.min[axis], before.min[axis]},
                                   std::pair{now.max[axis], before.max[axis]}})
            if (x != y)
                step = std::max({step, std::abs(x - y), FLT_MIN});
    return step;
}

std::size_t follow_blocks(Boxes now, Box* kept, std::size_t begin, std::size_t end, float most,
                          float* steps, std::uint32_t* far) {
    return HWY_DYNAMIC_DISPATCH(FollowBlocks)(now, kept, begin, end, most, steps, far);
}

} // namespace boxwood
#endif
