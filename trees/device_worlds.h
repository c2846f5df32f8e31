#pragma once

#include "trees/device_memory.h"
#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace boxwood {

namespace detail {
class DeviceWorldsTree;
}

/// Many worlds of boxes that do not meet each other, in one tree on a device: thousands of
/// environments, say, in which one robot is trained. Made for worlds of up to some thousands of
/// boxes. Spans, answers and exceptions as for DeviceBvh.
class DeviceWorlds {
  public:
    /// The boxes of world w are boxes[first[w]] up to boxes[first[w + 1]]: `first` begins with 0,
    /// never falls, and ends with the number of boxes, else std::invalid_argument.
    DeviceWorlds(Boxes boxes, std::span<const std::uint32_t> first, DevicePlace place = {});
    DeviceWorlds(DeviceSpan<const Box> boxes, std::span<const std::uint32_t> first,
                 DevicePlace place = {});
    DeviceWorlds(DeviceWorlds&&) noexcept;
    DeviceWorlds& operator=(DeviceWorlds&&) noexcept;
    ~DeviceWorlds();

    std::size_t size() const; ///< boxes in all worlds; 0 after an exception
    std::size_t n_worlds() const { return n_worlds_; }

    /// The boxes moved: the tree is made again. Of as many boxes in the same worlds, else
    /// std::invalid_argument.
    void update(Boxes boxes);
    void update(DeviceSpan<const Box> boxes);

    /// By world the pairs of its items whose boxes overlap, each once, the lower item first; items
    /// are numbered over all worlds.
    AnswersOf<Pair> self_pairs() const;
    DeviceAnswersOf<Pair> self_pairs_on_device() const;

  private:
    void require_as_many(std::size_t n_boxes) const;

    std::size_t n_worlds_ = 0, n_boxes_ = 0;
    DevicePlace place_;
    DeviceArray<Box> own_; ///< of boxes that came from the host
    std::unique_ptr<detail::DeviceWorldsTree> tree_;
};

} // namespace boxwood
