#include "trees/updates/step_sample.h"

#include "trees/updates/box_steps.h"

#include <algorithm>

namespace boxwood {

void StepSample::start(Boxes boxes) {
    constexpr std::size_t most = 512;
    const std::size_t n = std::min(most, boxes.size());
    items_each_ = n == 0 ? 1 : static_cast<double>(boxes.size()) / static_cast<double>(n);
    items_.resize(n);
    boxes_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        // Somewhere in each part, so that no pattern in the numbers goes unseen.
        const std::size_t begin = boxes.size() * i / n, end = boxes.size() * (i + 1) / n;
        items_[i] = static_cast<std::uint32_t>(begin + (i * 2654435769u >> 8) % (end - begin));
        boxes_[i] = boxes[items_[i]];
    }
}

std::span<const float> StepSample::follow(Boxes boxes, std::span<const std::uint32_t> moved) {
    steps_.assign(items_.size(), 0);
    auto at = moved.begin();
    for (std::size_t i = 0; i < items_.size(); ++i) {
        const std::uint32_t item = items_[i];
        at = moved.size() == boxes.size() ? moved.begin() + item
                                          : std::lower_bound(at, moved.end(), item);
        if (at == moved.end())
            break;
        if (*at != item)
            continue;
        steps_[i] = box_step(boxes[item], boxes_[i]);
        boxes_[i] = boxes[item];
    }
    return steps_;
}

} // namespace boxwood
