#include "trees/device.h"

#include "trees/detail/device_tree.h"

#include <algorithm>
#include <cstdio>

namespace boxwood {
namespace {

std::string in_gb(std::uint64_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g GB", static_cast<double>(bytes) * 1e-9);
    return text;
}

void require_same_kind(const DeviceBvhOptions& a, const DeviceBvhOptions& b) {
    if (a.builder != b.builder || a.place.index != b.place.index ||
        a.place.stream != b.place.stream)
        throw std::invalid_argument(
            "pairs of two trees on a device: they must have the same builder, device and stream");
}

} // namespace

DeviceOutOfMemory::DeviceOutOfMemory(const std::string& what, std::uint64_t needed_,
                                     std::uint64_t free_)
    : DeviceError(what + " needs " + in_gb(needed_) + " of the device's memory, and " +
                  in_gb(free_) + " are free"),
      needed(needed_), free(free_) {}

DeviceBvh::DeviceBvh(Boxes boxes, const DeviceBvhOptions& options)
    : options_(options), tree_(detail::make_device_tree(options)) {
    rebuild(boxes);
}
DeviceBvh::DeviceBvh(DeviceSpan<const Box> boxes, const DeviceBvhOptions& options)
    : options_(options), tree_(detail::make_device_tree(options)) {
    rebuild(boxes);
}
DeviceBvh::DeviceBvh(DeviceBvh&&) noexcept = default;
DeviceBvh& DeviceBvh::operator=(DeviceBvh&&) noexcept = default;
DeviceBvh::~DeviceBvh() = default;

std::size_t DeviceBvh::size() const { return tree_->size(); }

void DeviceBvh::update(Boxes boxes) {
    if (boxes.size() != size() || own_.size() != size())
        return rebuild(boxes);
    own_.write(boxes);
    tree_->refit(own_.span());
}
void DeviceBvh::update(DeviceSpan<const Box> boxes) {
    if (boxes.size != size())
        return rebuild(boxes);
    tree_->refit(boxes);
    own_ = {};
}
void DeviceBvh::rebuild(Boxes boxes) {
    if (own_.size() != boxes.size())
        own_ = {}; // not both at the same time
    if (own_.size() == boxes.size())
        own_.write(boxes);
    else
        own_ = DeviceArray<Box>(boxes, options_.place);
    tree_->build(own_.span());
}
void DeviceBvh::rebuild(DeviceSpan<const Box> boxes) {
    tree_->build(boxes);
    own_ = {};
}

std::uint64_t DeviceBvh::self_pair_count() const { return tree_->count_pairs(*tree_); }
std::vector<Pair> DeviceBvh::self_pairs() const { return pairs(*this); }
void DeviceBvh::self_pairs(PairSink& sink) const { tree_->pairs(*tree_, sink); }
DeviceArray<Pair> DeviceBvh::self_pairs_on_device() const { return tree_->pairs(*tree_); }

std::uint64_t DeviceBvh::self_pairs_into(DeviceSpan<Pair> room) const {
    return last_pairs_ = tree_->self_pairs_into(room);
}
DeviceArray<Pair> DeviceBvh::unordered_self_pairs() const {
    DeviceArray<Pair> found(last_pairs_ + last_pairs_ / 8, options_.place);
    const std::size_t room = found.size();
    if (self_pairs_into(found.span()) > room) {
        found = {};
        found = DeviceArray<Pair>(last_pairs_, options_.place);
        self_pairs_into(found.span());
    }
    found.shrink(last_pairs_);
    return found;
}

std::uint64_t DeviceBvh::pair_count(const DeviceBvh& other) const {
    require_same_kind(options_, other.options_);
    return tree_->count_pairs(*other.tree_);
}
std::vector<Pair> DeviceBvh::pairs(const DeviceBvh& other) const {
    std::vector<Pair> found;
    AppendPairs append(found);
    pairs(other, append);
    return found;
}
void DeviceBvh::pairs(const DeviceBvh& other, PairSink& sink) const {
    require_same_kind(options_, other.options_);
    tree_->pairs(*other.tree_, sink);
}
DeviceArray<Pair> DeviceBvh::pairs_on_device(const DeviceBvh& other) const {
    require_same_kind(options_, other.options_);
    return tree_->pairs(*other.tree_);
}

} // namespace boxwood
