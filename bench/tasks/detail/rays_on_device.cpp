#include "bench/tasks/detail/rays_on_device.h"

namespace boxwood::bench {
namespace {

std::optional<DeviceRayKernel> device_kernel(std::string_view name) {
    if (name == "watertight")
        return DeviceRayKernel::watertight;
    if (name == "moller_trumbore_f32")
        return DeviceRayKernel::moller_trumbore_f32;
    if (name == "moller_trumbore_f64")
        return DeviceRayKernel::moller_trumbore_f64;
    return std::nullopt;
}

} // namespace

std::optional<DeviceMeshBvhOptions> device_options(const Choice& choice) {
    const std::optional<DeviceBuilder> builder = device_builder(choice, "wide8");
    const std::optional<DeviceRayKernel> kernel = device_kernel(choice.kernel);
    if (!builder || !kernel)
        return std::nullopt;
    return DeviceMeshBvhOptions{*builder, *kernel, choice.ray_order == "sorted", bench_place()};
}

std::uint64_t RaysOnDevice::upload() {
    vertices_ = DeviceArray<Vec3<float>>(scene_.mesh.vertices, options_.place);
    triangles_ = DeviceArray<DeviceMeshBvh::Corners>(scene_.mesh.triangles, options_.place);
    return vertices_.size_bytes() + triangles_.size_bytes();
}

void RaysOnDevice::build_there() {
    mesh_.reset();
    mesh_.emplace(std::as_const(vertices_).span(), std::as_const(triangles_).span(), options_);
}

} // namespace boxwood::bench
