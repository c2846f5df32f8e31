#include "trees/dynamic/detail/margins.h"

#include <algorithm>
#include <limits>

namespace boxwood::detail {

void Margins::start(Boxes boxes, double share) {
    double sides = 0;
    std::size_t present = 0;
    for (const Box& box : boxes) {
        if (box.is_empty())
            continue;
        ++present;
        const auto side = static_cast<Vec3<double>>(box.max) - static_cast<Vec3<double>>(box.min);
        sides += side.x + side.y + side.z;
    }
    start_wide(boxes, share * sides / (present == 0 ? 1 : 3 * static_cast<double>(present)));
}

void Margins::start_wide(Boxes boxes, double margin) {
    constexpr double max_float = std::numeric_limits<float>::max();
    margin_ = static_cast<float>(std::min(margin, max_float));
    fat_.resize(boxes.size());
    std::ranges::transform(boxes, fat_.begin(), [&](const Box& box) { return around(box); });
    left_.reserve(boxes.size());
}

/// Clamped to finite floats, so that it is a valid box; around an absent box it is absent.
Box Margins::around(const Box& box) const {
    constexpr float max_float = std::numeric_limits<float>::max();
    const Vec3<float> m{margin_, margin_, margin_}, limit{max_float, max_float, max_float};
    return {max(box.min - m, Vec3<float>{} - limit), min(box.max + m, limit)};
}

bool Margins::has_left(std::uint32_t item, const Box& box) const {
    const Box& fat = fat_[item]; // without branches: many may have left
    return !((fat.min.x <= box.min.x) & (fat.min.y <= box.min.y) & (fat.min.z <= box.min.z) &
             (box.max.x <= fat.max.x) & (box.max.y <= fat.max.y) & (box.max.z <= fat.max.z));
}

std::span<const std::uint32_t> Margins::left(Boxes boxes, std::span<const std::uint32_t> moved) {
    left_.resize(moved.size());
    std::size_t n = 0;
    for (const std::uint32_t item : moved) {
        left_[n] = item;
        n += has_left(item, boxes[item]);
    }
    left_.resize(n);
    return left_;
}

void Margins::follow(Boxes boxes, std::span<const std::uint32_t> items) {
    for (const std::uint32_t item : items)
        fat_[item] = around(boxes[item]);
}

} // namespace boxwood::detail
