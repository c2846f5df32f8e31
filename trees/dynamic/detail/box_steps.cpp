// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/dynamic/detail/box_steps.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/dynamic/detail/box_steps.h"

#include <algorithm>
#include <cfloat>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 16> df;
constexpr std::size_t lanes = hn::MaxLanes(df);
constexpr std::size_t block_floats = 6 * follow_block;

bool are_ascending(std::span<const std::uint32_t> items) {
    constexpr hn::RebindToUnsigned<decltype(df)> du;
    auto rising = hn::Eq(hn::Zero(du), hn::Zero(du));
    std::size_t i = 0;
    for (; i + lanes < items.size(); i += lanes)
        rising = hn::And(
            rising, hn::Lt(hn::LoadU(du, items.data() + i), hn::LoadU(du, items.data() + i + 1)));
    bool all = hn::AllTrue(du, rising);
    for (; i + 1 < items.size(); ++i)
        all = all && items[i] < items[i + 1];
    return all;
}

std::size_t follow_blocks(Boxes now, Box* HWY_RESTRICT before, std::size_t begin, std::size_t end,
                          float max_step, float* HWY_RESTRICT steps,
                          std::uint32_t* HWY_RESTRICT far) {
    std::size_t n_far = 0;
    for (std::size_t b = begin; b < end; ++b) {
        const std::size_t first = b * follow_block,
                          count = std::min(follow_block, now.size() - first);
        float step = 0;
        const bool whole = count == follow_block;
        if (whole) {
            const float* const from = reinterpret_cast<const float*>(&now[first]);
            const float* const last = reinterpret_cast<const float*>(before + first);
            auto all = hn::Zero(df);
            for (std::size_t i = 0; i < block_floats; i += lanes) {
                const auto x = hn::LoadU(df, from + i), y = hn::LoadU(df, last + i);
                // Infinities that are the same, of an absent box, have gone nowhere.
                const auto d = hn::Max(hn::Abs(hn::Sub(x, y)), hn::Set(df, FLT_MIN));
                all = hn::Max(all, hn::IfThenElseZero(hn::Ne(x, y), d));
            }
            step = hn::GetLane(hn::MaxOfLanes(df, all));
        } else {
            for (std::size_t i = first; i < first + count; ++i)
                step = std::max(step, box_step(now[i], before[i]));
        }
        steps[b] = step;
        if (!(step <= max_step)) {
            far[n_far++] = static_cast<std::uint32_t>(b);
        } else if (whole) {
            const float* const from = reinterpret_cast<const float*>(&now[first]);
            float* const to = reinterpret_cast<float*>(before + first);
            for (std::size_t i = 0; i < block_floats; i += lanes)
                hn::StoreU(hn::LoadU(df, from + i), df, to + i);
        } else {
            std::copy_n(&now[first], count, before + first);
        }
    }
    return n_far;
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(are_ascending);
HWY_EXPORT(follow_blocks);

bool are_ascending(std::span<const std::uint32_t> items) {
    return HWY_DYNAMIC_DISPATCH(are_ascending)(items);
}

std::size_t follow_blocks(Boxes now, Box* before, std::size_t begin, std::size_t end,
                          float max_step, float* steps, std::uint32_t* far) {
    return HWY_DYNAMIC_DISPATCH(follow_blocks)(now, before, begin, end, max_step, steps, far);
}

} // namespace boxwood::detail
#endif
