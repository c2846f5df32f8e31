// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/dynamic/detail/survey.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/dynamic/detail/survey.h"
#include "trees/executors/chunks.h"
#include "trees/ordering/curve_codes.h"

#include <algorithm>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

inline bool add_box(const Box& box, Survey& to) {
    if (is_absent(box)) {
        to.some_absent = true;
        return true;
    }
    to.centres.extend(.5f * box.min + .5f * box.max);
    return box.is_valid();
}

/// Adds boxes of which some are absent; false if one of them is neither that nor valid. Without
/// branches: any of them may be absent.
bool add_boxes(Boxes boxes, Survey& to) {
    constexpr hn::CappedTag<float, 4> d;
    bool good = true;
    std::size_t i = 0;
    if constexpr (hn::MaxLanes(d) == 4) {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        const auto inf = hn::Set(d, infinity), none = hn::Neg(inf), half = hn::Set(d, .5f);
        auto low = inf, high = none;
        std::uint32_t bad = 0, gone = 0;
        for (; i + 1 < boxes.size(); ++i) { // the fourth lane is of the next box
            const float* const at = &boxes[i].min.x;
            const auto min = hn::LoadU(d, at), max = hn::LoadU(d, at + 3);
            const auto centre = hn::Add(hn::Mul(min, half), hn::Mul(max, half));
            const auto valid = hn::And(hn::Le(min, max), hn::Lt(hn::Abs(centre), inf));
            const auto absent = hn::And(hn::Eq(min, inf), hn::Eq(max, none));
            std::uint8_t valid_bits[8] = {}, absent_bits[8] = {};
            hn::StoreMaskBits(d, valid, valid_bits);
            hn::StoreMaskBits(d, absent, absent_bits);
            const std::uint32_t valid3 = valid_bits[0] & 7u, absent3 = absent_bits[0] & 7u;
            bad |=
                static_cast<std::uint32_t>(valid3 != 7) & static_cast<std::uint32_t>(absent3 != 7);
            gone |= static_cast<std::uint32_t>(absent3 == 7);
            low = hn::Min(low, hn::IfThenElse(valid, centre, inf));
            high = hn::Max(high, hn::IfThenElse(valid, centre, none));
        }
        alignas(16) float lows[4], highs[4];
        hn::Store(low, d, lows);
        hn::Store(high, d, highs);
        to.centres.extend(Box{{lows[0], lows[1], lows[2]}, {highs[0], highs[1], highs[2]}});
        to.some_absent = to.some_absent || gone;
        good = bad == 0;
    }
    for (; i < boxes.size(); ++i)
        good = add_box(boxes[i], to) && good;
    return good;
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(add_boxes);

/// Branches are for what is rare: half of an extent is below infinity only if both ends are finite.
void require_present_or_absent(std::uint32_t item, const Box& box) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const auto good = [&](float min, float max) {
        return (min <= max) & (.5f * max - .5f * min < infinity);
    };
    if (good(box.min.x, box.max.x) & good(box.min.y, box.max.y) & good(box.min.z, box.max.z))
        return;
    if (!is_absent(box))
        throw InvalidBox(item, "a NaN, an infinity or min > max; give finite corners, min <= max, "
                               "or Box{} for an item that is absent");
}

Survey survey_of(Boxes boxes, const Executor& executor) {
    if (boxes.size() > max_items)
        require_valid(boxes);
    struct Part {
        Survey survey;
        bool good = true;
    };
    const std::size_t chunks = chunks_for(boxes.size(), executor);
    std::vector<Part> parts(chunks);
    executor.for_each(chunks, [&](std::size_t c) {
        constexpr std::size_t some = 1024;
        Part& part = parts[c];
        const ChunkRange range(boxes.size(), chunks, c);
        for (std::size_t first = range.begin; first < range.end; first += some) {
            const Boxes these = boxes.subspan(first, std::min(some, range.end - first));
            if (!part.survey.some_absent) { // hopefully not here either
                const CentreBounds all_present = measure_centres(these);
                if (all_present.valid) {
                    part.survey.centres.extend(all_present.box);
                    continue;
                }
            }
            part.good &= HWY_DYNAMIC_DISPATCH(add_boxes)(these, part.survey);
        }
    });
    Survey survey;
    bool good = true;
    for (const Part& part : parts) {
        survey.centres.extend(part.survey.centres);
        survey.some_absent |= part.survey.some_absent;
        good &= part.good;
    }
    if (!good)
        for (std::size_t i = 0; i < boxes.size(); ++i)
            require_present_or_absent(static_cast<std::uint32_t>(i), boxes[i]);
    return survey;
}

} // namespace boxwood::detail
#endif
