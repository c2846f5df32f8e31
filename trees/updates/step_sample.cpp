#include "trees/updates/step_sample.h"

#include "trees/updates/box_steps.h"
#include "trees/updates/item_sample.h"

#include <algorithm>

namespace boxwood {

void StepSample::start(Boxes boxes) {
    constexpr std::size_t most = 512;
    items_ = sampled_items(boxes.size(), most);
    items_each_ =
        items_.empty() ? 1 : static_cast<double>(boxes.size()) / static_cast<double>(items_.size());
    boxes_.clear();
    for (const std::uint32_t item : items_)
        boxes_.push_back(boxes[item]);
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
