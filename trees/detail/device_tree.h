#pragma once

#include "trees/device.h"

namespace boxwood::detail {

/// What DeviceBvh is on a device: trees/cuda/device/tree.cu, or nothing
/// (trees/cuda/device/unavailable.cpp).
class DeviceTree {
  public:
    virtual ~DeviceTree() = default;
    virtual std::size_t size() const = 0;
    virtual void build(DeviceSpan<const Box> boxes) = 0;
    /// As many boxes as there were.
    virtual void refit(DeviceSpan<const Box> boxes) = 0;

    /// `other` may be this tree: each pair once then. It is of the same builder and place.
    virtual std::uint64_t count_pairs(const DeviceTree& other) = 0;
    virtual DeviceArray<Pair> pairs(const DeviceTree& other) = 0;
    virtual void pairs(const DeviceTree& other, PairSink& sink) = 0;
    /// As DeviceBvh::self_pairs_into.
    virtual std::uint64_t self_pairs_into(DeviceSpan<Pair> room) = 0;
};

/// Throws DeviceError if there is no such device.
std::unique_ptr<DeviceTree> make_device_tree(const DeviceBvhOptions& options);

} // namespace boxwood::detail
