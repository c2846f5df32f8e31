#pragma once

#include "kernels/primitives/rigid_transform.h"
#include "kernels/primitives/triangle.h"

#include <coal/BVH/BVH_model.h>
#include <coal/collision_data.h>

#include <cstddef>
#include <memory>
#include <vector>

/// What the files of the module share: our types as Coal's.
namespace boxwood::bench {

inline coal::Vec3s vector(Vec3<double> v) { return {v.x, v.y, v.z}; }

inline coal::Transform3s transform_of(const RigidTransform<double>& pose) {
    coal::Matrix3s rotation;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            rotation(i, j) = pose.rotation[static_cast<std::size_t>(i)][j];
    return {rotation, vector(pose.translation)};
}

struct MeshOfCoal {
    std::vector<coal::Vec3s> vertices;
    std::vector<coal::Triangle> triangles;

    template <class Vertices, class Triangles>
    MeshOfCoal(const Vertices& of_vertices, const Triangles& of_triangles) {
        for (const auto& v : of_vertices)
            vertices.push_back(vector(Vec3<double>(v)));
        for (const auto& [a, b, c] : of_triangles)
            triangles.emplace_back(a, b, c);
    }
    explicit MeshOfCoal(const TriangleMesh& mesh) : MeshOfCoal(mesh.vertices, mesh.triangles) {}

    template <class Volume> std::shared_ptr<coal::BVHModel<Volume>> model() const {
        auto made = std::make_shared<coal::BVHModel<Volume>>();
        made->beginModel(static_cast<unsigned>(triangles.size()),
                         static_cast<unsigned>(vertices.size()));
        made->addSubModel(vertices, triangles);
        made->endModel();
        return made;
    }
};

/// break_distance: boxes nearer than this are opened, so that a better lower bound of the distance
/// is found, which nobody reads here. distance_upper_bound 0: GJK ends as soon as it knows that two
/// triangles are farther apart than the margin.
inline coal::CollisionRequest request_of(std::size_t max_contacts, bool with_contact,
                                         double margin = 0) {
    coal::CollisionRequest request;
    request.num_max_contacts = max_contacts;
    request.enable_contact = with_contact;
    request.security_margin = margin;
    request.break_distance = 0;
    request.distance_upper_bound = 0;
    return request;
}

} // namespace boxwood::bench
