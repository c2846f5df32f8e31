#include "trees/device_worlds.h"

#include "trees/detail/device_tree.h"

#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

void require_worlds(std::span<const std::uint32_t> first, std::size_t n_boxes) {
    if (first.empty() || first.front() != 0 || first.back() != n_boxes)
        throw std::invalid_argument("worlds on a device: `first` begins with 0 and ends with the " +
                                    std::to_string(n_boxes) + " boxes that there are");
    for (std::size_t w = 0; w + 1 < first.size(); ++w)
        if (first[w] > first[w + 1])
            throw std::invalid_argument(
                "worlds on a device: `first` falls from " + std::to_string(first[w]) + " to " +
                std::to_string(first[w + 1]) + " after world " + std::to_string(w));
}

} // namespace

DeviceWorlds::DeviceWorlds(Boxes boxes, std::span<const std::uint32_t> first, DevicePlace place)
    : n_boxes_(boxes.size()), place_(place) {
    require_worlds(first, boxes.size());
    n_worlds_ = first.size() - 1;
    tree_ = detail::make_device_worlds(first, place);
    update(boxes);
}
DeviceWorlds::DeviceWorlds(DeviceSpan<const Box> boxes, std::span<const std::uint32_t> first,
                           DevicePlace place)
    : n_boxes_(boxes.size), place_(place) {
    require_worlds(first, boxes.size);
    n_worlds_ = first.size() - 1;
    tree_ = detail::make_device_worlds(first, place);
    update(boxes);
}
DeviceWorlds::DeviceWorlds(DeviceWorlds&&) noexcept = default;
DeviceWorlds& DeviceWorlds::operator=(DeviceWorlds&&) noexcept = default;
DeviceWorlds::~DeviceWorlds() = default;

std::size_t DeviceWorlds::size() const { return tree_->size(); }

void DeviceWorlds::require_as_many(std::size_t n_boxes) const {
    if (n_boxes != n_boxes_)
        throw std::invalid_argument("update of worlds by " + std::to_string(n_boxes) +
                                    " boxes, where there are " + std::to_string(n_boxes_));
}

void DeviceWorlds::update(Boxes boxes) {
    require_as_many(boxes.size());
    if (own_.size() != boxes.size())
        own_ = DeviceArray<Box>(boxes, place_);
    else
        own_.write(boxes);
    tree_->build(own_.span());
}
void DeviceWorlds::update(DeviceSpan<const Box> boxes) {
    require_as_many(boxes.size);
    tree_->build(boxes);
    own_ = {};
}

AnswersOf<Pair> DeviceWorlds::self_pairs() const { return self_pairs_on_device().to_host(); }
DeviceAnswersOf<Pair> DeviceWorlds::self_pairs_on_device() const { return tree_->pairs(); }

} // namespace boxwood
