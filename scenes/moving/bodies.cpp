#include "scenes/moving/bodies.h"

#include "kernels/arithmetic/rounding.h"
#include "kernels/boxes/fit.h"

#include <algorithm>

namespace boxwood {
namespace {

void add_at(Bodies& bodies, const Aabb<float>& rest, std::uint32_t mesh, Vec3<double> position) {
    bodies.rest.push_back(rest);
    bodies.mesh.push_back(mesh);
    bodies.pose.push_back({});
    bodies.pose.back().translation = position;
    bodies.velocity.push_back({});
    bodies.present.push_back(1);
}

Vec3<double> centre_of(const Aabb<float>& box) {
    return .5 * (static_cast<Vec3<double>>(box.min) + static_cast<Vec3<double>>(box.max));
}

} // namespace

void Bodies::add(const Aabb<float>& box) {
    const Vec3<double> centre = centre_of(box);
    const Aabb<double> own{static_cast<Vec3<double>>(box.min) - centre,
                           static_cast<Vec3<double>>(box.max) - centre};
    add_at(*this, round_outward(own), no_mesh, centre);
}

void Bodies::add(TriangleMesh mesh_of_it) {
    Aabb<float> box;
    for (const Vec3<float>& vertex : mesh_of_it.vertices)
        box.extend(vertex);
    const Vec3<float> centre = static_cast<Vec3<float>>(centre_of(box));
    Aabb<float> own;
    for (Vec3<float>& vertex : mesh_of_it.vertices) {
        vertex = vertex - centre;
        own.extend(vertex);
    }
    add_at(*this, own, static_cast<std::uint32_t>(meshes.size()),
           static_cast<Vec3<double>>(centre));
    meshes.push_back(std::move(mesh_of_it));
}

void Changed::clear() {
    for (const std::uint32_t body : bodies_)
        is_listed_[body] = 0;
    bodies_.clear();
}

/// Of many by looking at all.
void Changed::sort() {
    if (std::ranges::is_sorted(bodies_))
        return;
    if (bodies_.size() < is_listed_.size() / 16) {
        std::ranges::sort(bodies_);
        return;
    }
    bodies_.clear();
    for (std::uint32_t body = 0; body < is_listed_.size(); ++body)
        if (is_listed_[body] != 0)
            bodies_.push_back(body);
}

Aabb<float> fitted_box(const Bodies& bodies, std::uint32_t i) {
    if (!bodies.present[i])
        return {};
    const Aabb<float>& rest = bodies.rest[i];
    const Aabb<double> own{static_cast<Vec3<double>>(rest.min),
                           static_cast<Vec3<double>>(rest.max)};
    return round_outward(fit(bodies.pose[i], own));
}

} // namespace boxwood
