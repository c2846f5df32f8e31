#include "trees/device_mesh_bvh.h"

#include "trees/detail/device_tree.h"

namespace boxwood {

DeviceMeshBvh::DeviceMeshBvh(const TriangleMesh& mesh, const DeviceMeshBvhOptions& options)
    : DeviceMeshBvh(mesh.vertices, mesh.triangles, options) {}
DeviceMeshBvh::DeviceMeshBvh(std::span<const Vec3<float>> vertices,
                             std::span<const Corners> triangles,
                             const DeviceMeshBvhOptions& options)
    : options_(options), mesh_(detail::make_device_mesh(options)) {
    own_ = DeviceArray<Corners>(triangles, options.place);
    const DeviceArray<Vec3<float>> on_device(vertices, options.place);
    mesh_->build(on_device.span(), own_.span());
}
DeviceMeshBvh::DeviceMeshBvh(DeviceSpan<const Vec3<float>> vertices,
                             DeviceSpan<const Corners> triangles,
                             const DeviceMeshBvhOptions& options)
    : options_(options), mesh_(detail::make_device_mesh(options)) {
    mesh_->build(vertices, triangles);
}
DeviceMeshBvh::DeviceMeshBvh(DeviceMeshBvh&&) noexcept = default;
DeviceMeshBvh& DeviceMeshBvh::operator=(DeviceMeshBvh&&) noexcept = default;
DeviceMeshBvh::~DeviceMeshBvh() = default;

std::size_t DeviceMeshBvh::size() const { return mesh_->size(); }

void DeviceMeshBvh::update(std::span<const Vec3<float>> vertices) {
    update(DeviceArray<Vec3<float>>(vertices, options_.place).span());
}
void DeviceMeshBvh::update(DeviceSpan<const Vec3<float>> vertices) { mesh_->update(vertices); }

std::vector<RayHit> DeviceMeshBvh::closest_hits(std::span<const Ray<float>> rays) const {
    return closest_hits(DeviceArray<Ray<float>>(rays, options_.place).span()).to_host();
}
DeviceArray<RayHit> DeviceMeshBvh::closest_hits(DeviceSpan<const Ray<float>> rays) const {
    return mesh_->closest(rays);
}
std::vector<RayHit> DeviceMeshBvh::any_hits(std::span<const Ray<float>> rays) const {
    return any_hits(DeviceArray<Ray<float>>(rays, options_.place).span()).to_host();
}
DeviceArray<RayHit> DeviceMeshBvh::any_hits(DeviceSpan<const Ray<float>> rays) const {
    return mesh_->any(rays);
}
AnswersOf<RayHit> DeviceMeshBvh::all_hits(std::span<const Ray<float>> rays) const {
    return all_hits(DeviceArray<Ray<float>>(rays, options_.place).span()).to_host();
}
DeviceAnswersOf<RayHit> DeviceMeshBvh::all_hits(DeviceSpan<const Ray<float>> rays) const {
    return mesh_->all(rays);
}

} // namespace boxwood
