#include "trees/updates/far_sample.h"

#include "trees/updates/box_steps.h"
#include "trees/updates/item_sample.h"

#include <algorithm>
#include <cmath>

namespace boxwood {

void FarSample::start(Boxes boxes, double reach) {
    constexpr std::size_t most = 1024, few = 16;
    const std::size_t n = boxes.size();
    items_ = sampled_items(n, n < most ? n : std::min(most, n / few));
    if (items_.empty())
        return;
    items_each_ = static_cast<double>(n) / static_cast<double>(items_.size());
    boxes_.clear();
    double sides = 0, present = 0;
    Aabb<double> room;
    for (const std::uint32_t item : items_) {
        const Box& box = boxes[item];
        boxes_.push_back(box);
        if (is_absent(box))
            continue;
        const Vec3<double> low(box.min), side = Vec3<double>(box.max) - low;
        sides += (side.x + side.y + side.z) / 3;
        room.extend(low);
        ++present;
    }
    reach_ = 0;
    if (present == 0)
        return;
    constexpr double block = 16;
    const Vec3<double> extent = room.max - room.min;
    const double share = extent.x * extent.y * extent.z * block / (present * items_each_);
    reach_ = reach * std::max(sides / present, std::cbrt(share));
}

std::size_t FarSample::about(Boxes boxes) const {
    std::size_t far = 0;
    for (std::size_t k = 0; k < items_.size(); ++k)
        far += double{box_step(boxes[items_[k]], boxes_[k])} > reach_;
    return static_cast<std::size_t>(std::lround(static_cast<double>(far) * items_each_));
}

} // namespace boxwood
