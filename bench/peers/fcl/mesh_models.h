#pragma once

#include "bench/tasks/contender.h"
#include "bench/tasks/detail/mesh_pair_answers.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include <memory>
#include <vector>

namespace boxwood::bench {

/// FCL's model of the scene's mesh, which stands for the mesh and for its copy.
template <class Volume> class MeshModels : public Contender {
  public:
    explicit MeshModels(const Job& job) : scene_(*job.scene) {
        for (const Vec3<float>& v : scene_.mesh.vertices)
            vertices_.emplace_back(static_cast<double>(v.x), static_cast<double>(v.y),
                                   static_cast<double>(v.z));
        for (const auto& [a, b, c] : scene_.mesh.triangles)
            triangles_.emplace_back(a, b, c);
        for (const RigidTransform<double>& pose : scene_.poses) {
            fcl::Transform3d& placed = poses_.emplace_back(fcl::Transform3d::Identity());
            for (int i = 0; i < 3; ++i) {
                const Vec3<double>& row = pose.rotation[static_cast<std::size_t>(i)];
                for (int j = 0; j < 3; ++j)
                    placed.linear()(i, j) = row[j];
                placed.translation()(i) = pose.translation[i];
            }
        }
    }
    void build() override {
        model_.reset();
        model_ = std::make_unique<fcl::BVHModel<Volume>>();
        model_->beginModel(static_cast<int>(triangles_.size()), static_cast<int>(vertices_.size()));
        model_->addSubModel(vertices_, triangles_);
        model_->endModel();
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
    std::vector<fcl::Vector3d> vertices_;
    std::vector<fcl::Triangle> triangles_;
};

} // namespace boxwood::bench
