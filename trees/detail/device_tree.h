#pragma once

#include "trees/device_bvh.h"
#include "trees/device_mesh_bvh.h"
#include "trees/device_worlds.h"

namespace boxwood::detail {

/// What DeviceBvh is on a device: trees/cuda/device/tree.cu, or nothing
/// (trees/cuda/device/unavailable.cpp).
class DeviceTree {
  public:
    virtual ~DeviceTree() = default;
    virtual std::size_t size() const = 0;
    /// After an exception it is empty.
    virtual void build(DeviceSpan<const Box> boxes) = 0;
    /// As many boxes as there were.
    virtual void refit(DeviceSpan<const Box> boxes) = 0;
    /// As DeviceBvh has them.
    virtual void enqueue_build(DeviceSpan<const Box> boxes) = 0;
    virtual void enqueue_refit(DeviceSpan<const Box> boxes) = 0;
    virtual bool check() = 0;

    /// `other` may be this tree: each pair once then. It is of the same builder and place.
    virtual std::uint64_t count_pairs(const DeviceTree& other) = 0;
    virtual DeviceArray<Pair> pairs(const DeviceTree& other) = 0;
    virtual void pairs(const DeviceTree& other, PairSink& sink) = 0;
    virtual void enqueue_self_pairs(DeviceSpan<Pair> room, std::uint64_t* count) = 0;

    virtual DeviceAnswersOf<std::uint32_t> regions(DeviceSpan<const Box> of) = 0;
    virtual DeviceAnswersOf<std::uint32_t> regions(DeviceSpan<const Vec3<float>> of) = 0;
    virtual DeviceAnswersOf<std::uint32_t> regions(DeviceSpan<const Sphere<float>> of) = 0;
    virtual DeviceArray<Neighbour> nearest(DeviceSpan<const Vec3<float>> points, std::size_t k) = 0;
};

/// What DeviceMeshBvh is: trees/cuda/device/mesh.cuh.
class DeviceMesh {
  public:
    using Corners = DeviceMeshBvh::Corners;

    virtual ~DeviceMesh() = default;
    virtual std::size_t size() const = 0;
    virtual void build(DeviceSpan<const Vec3<float>> vertices,
                       DeviceSpan<const Corners> triangles) = 0;
    virtual void update(DeviceSpan<const Vec3<float>> vertices) = 0;
    virtual DeviceArray<RayHit> closest(DeviceSpan<const Ray<float>> rays) = 0;
    virtual DeviceArray<RayHit> any(DeviceSpan<const Ray<float>> rays) = 0;
    virtual DeviceAnswersOf<RayHit> all(DeviceSpan<const Ray<float>> rays) = 0;
};

/// What DeviceWorlds is: trees/cuda/device/many_worlds.cuh.
class DeviceWorldsTree {
  public:
    virtual ~DeviceWorldsTree() = default;
    virtual std::size_t size() const = 0;
    /// After an exception it is empty.
    virtual void build(DeviceSpan<const Box> boxes) = 0;
    virtual DeviceAnswersOf<Pair> pairs() = 0;
};

/// Throw DeviceError if there is no such device.
std::unique_ptr<DeviceTree> make_device_tree(const DeviceBvhOptions& options);
std::unique_ptr<DeviceMesh> make_device_mesh(const DeviceMeshBvhOptions& options);
std::unique_ptr<DeviceWorldsTree> make_device_worlds(std::span<const std::uint32_t> first,
                                                     const DevicePlace& place);

} // namespace boxwood::detail
