#pragma once

#include "bench/tasks/contender.h"
#include "bench/tasks/detail/mesh_pair_answers.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include <memory>
#include <vector>

namespace boxwood::bench {

inline fcl::Transform3d transform_of(const RigidTransform<double>& pose) {
    fcl::Transform3d transform = fcl::Transform3d::Identity();
    for (int i = 0; i < 3; ++i) {
        const Vec3<double>& row = pose.rotation[static_cast<std::size_t>(i)];
        for (int j = 0; j < 3; ++j)
            transform.linear()(i, j) = row[j];
        transform.translation()(i) = pose.translation[i];
    }
    return transform;
}

/// A mesh in FCL's own types.
struct MeshOfFcl {
    std::vector<fcl::Vector3d> vertices;
    std::vector<fcl::Triangle> triangles;

    explicit MeshOfFcl(const TriangleMesh& mesh) {
        for (const Vec3<float>& v : mesh.vertices)
            vertices.emplace_back(static_cast<double>(v.x), static_cast<double>(v.y),
                                  static_cast<double>(v.z));
        for (const auto& [a, b, c] : mesh.triangles)
            triangles.emplace_back(a, b, c);
    }
    /// Makes an empty model this mesh's, split at the mean, the default.
    template <class Volume> void build(fcl::BVHModel<Volume>& model) const {
        model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
        model.addSubModel(vertices, triangles);
        model.endModel();
    }
};

/// FCL's model of the scene's mesh, which stands for the mesh and for its copy.
template <class Volume> class MeshModels : public Contender {
  public:
    explicit MeshModels(const Job& job) : scene_(*job.scene), mesh_(scene_.mesh) {
        for (const RigidTransform<double>& pose : scene_.poses)
            poses_.push_back(transform_of(pose));
    }
    void build() override {
        model_.reset();
        model_ = std::make_unique<fcl::BVHModel<Volume>>();
        mesh_.build(*model_);
    }

  protected:
    const Scene& scene_;
    std::vector<fcl::Transform3d> poses_;
    std::unique_ptr<fcl::BVHModel<Volume>> model_;

    std::size_t collide_at(std::size_t i, const fcl::CollisionRequestd& request) {
        result_.clear();
        return fcl::collide<double>(model_.get(), fcl::Transform3d::Identity(), model_.get(),
                                    poses_[i], request, result_);
    }
    fcl::CollisionResultd result_;

  private:
    MeshOfFcl mesh_;
};

} // namespace boxwood::bench
