#include "trees/dynamic/detail/widen.h"

#include "trees/dynamic/detail/survey.h"
#include "trees/executors/chunks.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace boxwood::detail {

double median_side(Boxes boxes) {
    constexpr std::size_t max_sampled = 1023;
    std::vector<double> sides;
    const std::size_t step = boxes.size() / max_sampled + 1;
    for (std::size_t i = 0; i < boxes.size(); i += step)
        if (!is_absent(boxes[i])) {
            const auto side = Vec3<double>(boxes[i].max) - Vec3<double>(boxes[i].min);
            sides.push_back((side.x + side.y + side.z) / 3);
        }
    if (sides.empty())
        return 1;
    const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
    std::ranges::nth_element(sides, middle);
    return std::max(*middle, double{FLT_MIN});
}

/// Each of the three operations on a coordinate x is rounded by at most 2^-24 of about |x| + m, and
/// by FLT_MIN where denormal numbers are flushed: 2^-22 |x|, 2^-18 m and 16 FLT_MIN are more.
void widen_boxes(Boxes boxes, double margin, std::vector<Box>& widened, const Executor& executor) {
    widened.resize(boxes.size());
    const float m = static_cast<float>(margin * (1 + 0x1p-18)) + 16 * FLT_MIN;
    const std::size_t chunks = chunks_for(boxes.size(), executor);
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(boxes.size(), chunks, c);
        for (std::size_t i = range.begin; i < range.end; ++i) {
            widened[i] = boxes[i];
            if (is_absent(boxes[i]))
                continue;
            for (int axis = 0; axis < 3; ++axis) {
                const float low = boxes[i].min[axis], high = boxes[i].max[axis];
                widened[i].min[axis] = std::max(low - (m + std::abs(low) * 0x1p-22f), -FLT_MAX);
                widened[i].max[axis] = std::min(high + (m + std::abs(high) * 0x1p-22f), FLT_MAX);
            }
        }
    });
}

} // namespace boxwood::detail
