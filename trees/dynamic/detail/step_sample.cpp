#include "trees/dynamic/detail/step_sample.h"

#include "trees/dynamic/detail/box_steps.h"
#include "trees/dynamic/detail/item_sample.h"

#include <algorithm>

namespace boxwood::detail {

void StepSample::start(Boxes boxes) {
    constexpr std::size_t max_sampled = 512;
    items_ = sampled_items(boxes.size(), max_sampled);
    items_each_ =
        items_.empty() ? 1 : static_cast<double>(boxes.size()) / static_cast<double>(items_.size());
    boxes_.clear();
    for (const std::uint32_t item : items_)
        boxes_.push_back(boxes[item]);
}

std::span<const float> StepSample::follow(Boxes boxes, std::span<const std::uint32_t> moved) {
    steps_.assign(items_.size(), 0);
    const auto look = [&](std::size_t i) {
        steps_[i] = box_step(boxes[items_[i]], boxes_[i]);
        boxes_[i] = boxes[items_[i]];
    };
    if (moved.size() >= items_.size()) { // those that have not moved have their old boxes
        for (std::size_t i = 0; i < items_.size(); ++i)
            look(i);
        return steps_;
    }
    auto at = items_.begin();
    for (const std::uint32_t item : moved) {
        at = std::lower_bound(at, items_.end(), item);
        if (at != items_.end() && *at == item)
            look(static_cast<std::size_t>(at - items_.begin()));
    }
    return steps_;
}

} // namespace boxwood::detail
