#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"
#include "trees/device_memory.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace boxwood {

/// kernels/ray_triangle/: watertight.h, moller_trumbore.h.
enum class DeviceRayKernel : std::uint8_t { watertight, moller_trumbore_f32, moller_trumbore_f64 };

struct DeviceMeshBvhOptions {
    /// hilbert has a warp for each ray, for few of them at a time, and no all_hits.
    DeviceBuilder builder = DeviceBuilder::hploc;
    DeviceRayKernel kernel = DeviceRayKernel::watertight;
    bool sort_rays = false; ///< so that those of a warp visit much the same: for rays at random
    DevicePlace place = {};
};

namespace detail {
class DeviceMesh;
}

/// The triangles of a mesh on a device, for rays. What comes in host memory and what comes as a
/// DeviceSpan is as with DeviceBvh. Answers are those of the CPU to the bit (trees/queries/rays.h).
/// Throws DeviceError, DeviceOutOfMemory, std::length_error for more than max_items triangles,
/// InvalidBox for the first triangle with a coordinate that is not finite, and
/// std::invalid_argument for one of 2^126 or more, a triangle with a vertex that is not there, and
/// the wrong number of vertices. For one thread at a time.
class DeviceMeshBvh {
  public:
    using Corners = std::array<std::uint32_t, 3>; ///< the vertices of a triangle

    explicit DeviceMeshBvh(const TriangleMesh& mesh, const DeviceMeshBvhOptions& options = {});
    DeviceMeshBvh(std::span<const Vec3<float>> vertices, std::span<const Corners> triangles,
                  const DeviceMeshBvhOptions& options = {});
    /// The triangles stay the caller's, and as they are; the vertices are copied.
    DeviceMeshBvh(DeviceSpan<const Vec3<float>> vertices, DeviceSpan<const Corners> triangles,
                  const DeviceMeshBvhOptions& options = {});
    DeviceMeshBvh(DeviceMeshBvh&&) noexcept;
    DeviceMeshBvh& operator=(DeviceMeshBvh&&) noexcept;
    ~DeviceMeshBvh();

    /// Triangles.
    std::size_t size() const;
    const DeviceMeshBvhOptions& options() const { return options_; }

    /// The vertices moved: the same triangles are fitted into the tree as it is. A bad vertex
    /// empties it; after another exception it is as before.
    void update(std::span<const Vec3<float>> vertices);
    void update(DeviceSpan<const Vec3<float>> vertices);

    /// hits[i] answers rays[i]; a ray that is not finite is a miss. any_hits: some hit, the same
    /// each time.
    std::vector<RayHit> closest_hits(std::span<const Ray<float>> rays) const;
    DeviceArray<RayHit> closest_hits(DeviceSpan<const Ray<float>> rays) const;
    std::vector<RayHit> any_hits(std::span<const Ray<float>> rays) const;
    DeviceArray<RayHit> any_hits(DeviceSpan<const Ray<float>> rays) const;
    /// Every hit of every ray, by t and then by triangle. Not by hilbert: std::invalid_argument.
    AnswersOf<RayHit> all_hits(std::span<const Ray<float>> rays) const;
    DeviceAnswersOf<RayHit> all_hits(DeviceSpan<const Ray<float>> rays) const;

  private:
    DeviceMeshBvhOptions options_;
    DeviceArray<Corners> own_; ///< of triangles that came from the host
    std::unique_ptr<detail::DeviceMesh> mesh_;
};

} // namespace boxwood
