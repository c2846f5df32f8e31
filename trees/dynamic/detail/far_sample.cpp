#include "trees/dynamic/detail/far_sample.h"

#include "trees/dynamic/detail/box_steps.h"
#include "trees/dynamic/detail/item_sample.h"
#include "trees/dynamic/detail/survey.h"

#include <algorithm>
#include <cmath>

namespace boxwood::detail {

void FarSample::start(Boxes boxes, double reach) {
    constexpr std::size_t max_sampled = 1024, min_share = 32;
    const std::size_t n = boxes.size();
    if (n != n_)
        items_ =
            sampled_items(n, std::clamp(n / min_share, std::min(n, max_sampled / 4), max_sampled));
    n_ = n;
    boxes_.clear();
    far_.clear();
    if (items_.empty())
        return;
    items_each_ = static_cast<double>(n) / static_cast<double>(items_.size());
    double sides = 0, present = 0;
    Aabb<double> around;
    for (const std::uint32_t item : items_) {
        const Box& box = boxes[item];
        boxes_.push_back(box);
        if (is_absent(box))
            continue;
        const Vec3<double> low(box.min), side = Vec3<double>(box.max) - low;
        sides += (side.x + side.y + side.z) / 3;
        around.extend(low);
        ++present;
    }
    reach_ = 0;
    if (present == 0)
        return;
    const Vec3<double> extent = around.max - around.min;
    const double share = extent.x * extent.y * extent.z / (present * items_each_);
    reach_ = reach * std::max(sides / present, std::cbrt(share));
}

FarSample::Found FarSample::look(Boxes boxes) {
    far_.clear();
    double of_far = 0, of_all = 0;
    for (std::size_t k = 0; k < items_.size(); ++k) {
        const double step = box_step(boxes[items_[k]], boxes_[k]);
        const double counted = std::min(step, 4 * reach_);
        of_all += counted;
        if (step > reach_) {
            far_.push_back(static_cast<std::uint32_t>(k));
            of_far += counted;
        }
    }
    return {static_cast<std::size_t>(std::lround(static_cast<double>(far_.size()) * items_each_)),
            of_all > 0 ? of_far / of_all : 1};
}

void FarSample::start_far(Boxes boxes) {
    for (const std::uint32_t k : far_)
        boxes_[k] = boxes[items_[k]];
}

} // namespace boxwood::detail
