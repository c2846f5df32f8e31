#pragma once

#include "bench/tasks/detail/device_contender.h"

#include <optional>

namespace boxwood::bench {

/// What a device traces rays by as this choice does; nothing if it has no such form.
std::optional<DeviceMeshBvhOptions> device_options(const Choice& choice);

/// A tree of the scene's mesh, and its rays.
class RaysOnDevice : public DeviceContender {
  public:
    RaysOnDevice(const Job& job, const DeviceMeshBvhOptions& options)
        : DeviceContender(job), scene_(*job.scene), options_(options) {}

  protected:
    std::uint64_t upload() override;
    void build_there() override;
    std::uint64_t upload_queries() override {
        rays_ = DeviceArray<Ray<float>>(scene_.rays, options_.place);
        return rays_.size_bytes();
    }
    DeviceSpan<const Ray<float>> rays() const { return rays_.span(); }

    const Scene& scene_;
    DeviceMeshBvhOptions options_;
    std::optional<DeviceMeshBvh> mesh_;

  private:
    DeviceArray<Vec3<float>> vertices_;
    DeviceArray<DeviceMeshBvh::Corners> triangles_;
    DeviceArray<Ray<float>> rays_;
};

} // namespace boxwood::bench
