#pragma once

#include "kernels/primitives/sphere.h"
#include "kernels/primitives/vec3.h"
#include "trees/device_memory.h"
#include "trees/queries/nearest.h"
#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace boxwood {

// So that a simulation's own boxes on a device, min and then max, are taken as they are.
static_assert(sizeof(Box) == 6 * sizeof(float) && std::is_standard_layout_v<Box>);

struct DeviceBvhOptions {
    DeviceBuilder builder = DeviceBuilder::hilbert;
    DevicePlace place = {};
};

namespace detail {
class DeviceTree;
}

/// A tree of boxes on a device. What comes in host memory is copied there, and its answer back;
/// what comes as a DeviceSpan lies there already, and so does its answer, which is right for what
/// follows in the place's stream. Answers come in the same order each time, unless said otherwise.
/// Throws DeviceError, DeviceOutOfMemory, InvalidBox for the first bad box, and std::length_error
/// for more than max_items boxes. For one thread at a time.
class DeviceBvh {
  public:
    explicit DeviceBvh(Boxes boxes, const DeviceBvhOptions& options = {});
    /// The boxes stay the caller's, and as they are until the next update.
    explicit DeviceBvh(DeviceSpan<const Box> boxes, const DeviceBvhOptions& options = {});
    DeviceBvh(DeviceBvh&&) noexcept;
    DeviceBvh& operator=(DeviceBvh&&) noexcept;
    ~DeviceBvh();

    std::size_t size() const;
    const DeviceBvhOptions& options() const { return options_; }

    /// The boxes moved: as many as there were are fitted into the tree as it is, else, or by
    /// rebuild, it is made again. After an exception it is empty.
    void update(Boxes boxes);
    void update(DeviceSpan<const Box> boxes);
    void rebuild(Boxes boxes);
    void rebuild(DeviceSpan<const Box> boxes);

    /// The same without waiting. Once a rebuild of no fewer boxes was, no memory is allocated and
    /// none moves, so that a CUDA graph may capture these two and enqueue_self_pairs; a graph is
    /// good until the number of boxes changes. enqueue_update is of as many boxes as there are.
    /// Answers to bad boxes are wrong: check(), which waits, throws InvalidBox and empties the
    /// tree. It is false where a rebuild() would make a faster tree, as crowds of boxes need finer
    /// codes.
    void enqueue_rebuild(DeviceSpan<const Box> boxes);
    void enqueue_update(DeviceSpan<const Box> boxes);
    bool check();

    /// Pairs of items whose boxes overlap. To the host they come in parts where the memory for all
    /// is short.
    std::uint64_t self_pair_count() const;
    std::vector<Pair> self_pairs() const;
    void self_pairs(PairSink& sink) const;
    DeviceArray<Pair> self_pairs_on_device() const;
    /// In any order, by one pass: how many there are. Those beyond the room are left out.
    std::uint64_t self_pairs_into(DeviceSpan<Pair> room) const;
    /// So, without waiting: how many there are goes to *count, on the device.
    void enqueue_self_pairs(DeviceSpan<Pair> room, std::uint64_t* count) const;
    /// So, with room for somewhat more than the last time if there is memory for it, and a second
    /// pass if that is too little.
    DeviceArray<Pair> unordered_self_pairs() const;

    /// Pairs of an item here and one of the other tree, which has the same builder and place.
    std::uint64_t pair_count(const DeviceBvh& other) const;
    std::vector<Pair> pairs(const DeviceBvh& other) const;
    void pairs(const DeviceBvh& other, PairSink& sink) const;
    DeviceArray<Pair> pairs_on_device(const DeviceBvh& other) const;

    /// The items that share a point with each box or ball, or contain each point, ascending. A box
    /// with a NaN, or min > max, and a point that is not finite have none, nor has a ball as
    /// trees/queries/regions.h says.
    AnswersOf<std::uint32_t> overlapping(Boxes boxes) const;
    DeviceAnswersOf<std::uint32_t> overlapping(DeviceSpan<const Box> boxes) const;
    AnswersOf<std::uint32_t> overlapping(std::span<const Sphere<float>> balls) const;
    DeviceAnswersOf<std::uint32_t> overlapping(DeviceSpan<const Sphere<float>> balls) const;
    AnswersOf<std::uint32_t> containing(std::span<const Vec3<float>> points) const;
    DeviceAnswersOf<std::uint32_t> containing(DeviceSpan<const Vec3<float>> points) const;

    /// The k items nearest to each point, k to a point as trees/queries/nearest.h has them. Not by
    /// hilbert: std::invalid_argument.
    std::vector<Neighbour> nearest(std::span<const Vec3<float>> points, std::size_t k) const;
    DeviceArray<Neighbour> nearest(DeviceSpan<const Vec3<float>> points, std::size_t k) const;

  private:
    DeviceBvhOptions options_;
    DeviceArray<Box> own_; ///< of boxes that came from the host
    std::unique_ptr<detail::DeviceTree> tree_;
    mutable std::uint64_t last_pairs_ = 0;
};

} // namespace boxwood
