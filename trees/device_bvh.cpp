#include "trees/device_bvh.h"

#include "trees/detail/device_tree.h"

#include <stdexcept>

namespace boxwood {
namespace {

void require_same_kind(const DeviceBvhOptions& a, const DeviceBvhOptions& b) {
    if (a.builder != b.builder || a.place.index != b.place.index ||
        a.place.stream != b.place.stream)
        throw std::invalid_argument(
            "pairs of two trees on a device: they must have the same builder, device and stream");
}

} // namespace

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
    if (boxes.size() != size())
        return rebuild(boxes);
    if (own_.size() != size()) { // the boxes were the caller's
        try {
            own_ = DeviceArray<Box>(boxes, options_.place);
        } catch (...) {
            tree_->build({});
            throw;
        }
    } else {
        own_.write(boxes);
    }
    tree_->refit(own_.span());
}
void DeviceBvh::update(DeviceSpan<const Box> boxes) {
    if (boxes.size != size())
        return rebuild(boxes);
    tree_->refit(boxes);
    own_ = {};
}
void DeviceBvh::rebuild(Boxes boxes) {
    if (own_.size() != boxes.size()) {
        tree_->build({}); // which may be of them
        own_ = {};        // not both at the same time
        own_ = DeviceArray<Box>(boxes, options_.place);
    } else {
        own_.write(boxes);
    }
    tree_->build(own_.span());
}
void DeviceBvh::rebuild(DeviceSpan<const Box> boxes) {
    tree_->build(boxes);
    own_ = {};
}

void DeviceBvh::enqueue_rebuild(DeviceSpan<const Box> boxes) { tree_->enqueue_build(boxes); }
void DeviceBvh::enqueue_update(DeviceSpan<const Box> boxes) {
    if (boxes.size != size())
        throw std::invalid_argument("enqueue_update of " + std::to_string(boxes.size) +
                                    " boxes, where there are " + std::to_string(size()) +
                                    ": rebuild first");
    tree_->enqueue_refit(boxes);
}
bool DeviceBvh::check() { return tree_->check(); }

std::uint64_t DeviceBvh::self_pair_count() const { return tree_->count_pairs(*tree_); }
std::vector<Pair> DeviceBvh::self_pairs() const { return pairs(*this); }
void DeviceBvh::self_pairs(PairSink& sink) const { tree_->pairs(*tree_, sink); }
DeviceArray<Pair> DeviceBvh::self_pairs_on_device() const { return tree_->pairs(*tree_); }

std::uint64_t DeviceBvh::self_pairs_into(DeviceSpan<Pair> room) const {
    DeviceArray<std::uint64_t> count(1, options_.place);
    enqueue_self_pairs(room, count.span().data);
    return last_pairs_ = count.to_host()[0];
}
void DeviceBvh::enqueue_self_pairs(DeviceSpan<Pair> room, std::uint64_t* count) const {
    tree_->enqueue_self_pairs(room, count);
}
DeviceArray<Pair> DeviceBvh::unordered_self_pairs() const {
    DeviceArray<Pair> found;
    try {
        found = DeviceArray<Pair>(last_pairs_ + last_pairs_ / 8, options_.place);
    } catch (const DeviceOutOfMemory&) { // of pairs that may be fewer now: they are counted
    }
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

AnswersOf<std::uint32_t> DeviceBvh::overlapping(Boxes boxes) const {
    return overlapping(DeviceArray<Box>(boxes, options_.place).span()).to_host();
}
DeviceAnswersOf<std::uint32_t> DeviceBvh::overlapping(DeviceSpan<const Box> boxes) const {
    return tree_->regions(boxes);
}
AnswersOf<std::uint32_t> DeviceBvh::overlapping(std::span<const Sphere<float>> balls) const {
    return overlapping(DeviceArray<Sphere<float>>(balls, options_.place).span()).to_host();
}
DeviceAnswersOf<std::uint32_t> DeviceBvh::overlapping(DeviceSpan<const Sphere<float>> balls) const {
    return tree_->regions(balls);
}
AnswersOf<std::uint32_t> DeviceBvh::containing(std::span<const Vec3<float>> points) const {
    return containing(DeviceArray<Vec3<float>>(points, options_.place).span()).to_host();
}
DeviceAnswersOf<std::uint32_t> DeviceBvh::containing(DeviceSpan<const Vec3<float>> points) const {
    return tree_->regions(points);
}
std::vector<Neighbour> DeviceBvh::nearest(std::span<const Vec3<float>> points,
                                          std::size_t k) const {
    return nearest(DeviceArray<Vec3<float>>(points, options_.place).span(), k).to_host();
}
DeviceArray<Neighbour> DeviceBvh::nearest(DeviceSpan<const Vec3<float>> points,
                                          std::size_t k) const {
    return tree_->nearest(points, k);
}

} // namespace boxwood
