#pragma once

#include "bench/tasks/contender.h"
#include "scenes/scene.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>
#include <fcl/narrowphase/distance.h>

#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace boxwood::bench {

template <class S> fcl::Transform3<S> transform_of(const RigidTransform<double>& pose) {
    fcl::Transform3<S> transform = fcl::Transform3<S>::Identity();
    for (int i = 0; i < 3; ++i) {
        const Vec3<double>& row = pose.rotation[static_cast<std::size_t>(i)];
        for (int j = 0; j < 3; ++j)
            transform.linear()(i, j) = static_cast<S>(row[j]);
        transform.translation()(i) = static_cast<S>(pose.translation[i]);
    }
    return transform;
}

/// A mesh in FCL's own types.
template <class S> struct MeshOfFcl {
    std::vector<fcl::Vector3<S>> vertices;
    std::vector<fcl::Triangle> triangles;

    explicit MeshOfFcl(const TriangleMesh& mesh) {
        for (const Vec3<float>& v : mesh.vertices)
            vertices.emplace_back(static_cast<S>(v.x), static_cast<S>(v.y), static_cast<S>(v.z));
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

/// FCL's model of the scene's mesh, which stands for the mesh and for its copy; as
/// bench/peers/mesh_queries.h asks of it.
template <class Volume> class MeshModels : public Contender {
  public:
    using S = typename Volume::S;
    using CollisionRequest = fcl::CollisionRequest<S>;
    using DistanceRequest = fcl::DistanceRequest<S>;

    explicit MeshModels(const Job& job)
        : scene_(*job.scene), mesh_(scene_.mesh), other_mesh_(scene_.other_copy) {
        for (const RigidTransform<double>& pose : scene_.poses)
            poses_.push_back(transform_of<S>(pose));
    }
    void build() override {
        model_.reset();
        other_.reset();
        model_ = std::make_unique<fcl::BVHModel<Volume>>();
        mesh_.build(*model_);
        if (!scene_.has_other_copy())
            return;
        other_ = std::make_unique<fcl::BVHModel<Volume>>();
        other_mesh_.build(*other_);
    }

  protected:
    const Scene& scene_;
    std::vector<fcl::Transform3<S>> poses_;
    std::unique_ptr<fcl::BVHModel<Volume>> model_, other_; ///< other_: of a copy of its own

    const fcl::BVHModel<Volume>& copy() const { return other_ ? *other_ : *model_; }
    std::size_t n_poses() const { return poses_.size(); }
    std::size_t collide_at(std::size_t i, const CollisionRequest& request) {
        touches_.clear();
        return fcl::collide<S>(model_.get(), fcl::Transform3<S>::Identity(), &copy(), poses_[i],
                               request, touches_);
    }
    template <class Visit> void for_each_contact(Visit visit) const {
        for (std::size_t k = 0; k < touches_.numContacts(); ++k)
            visit(touches_.getContact(k));
    }
    static double depth_of(const fcl::Contact<S>& contact) {
        return static_cast<double>(contact.penetration_depth);
    }
    /// below: what is not nearer is left out of the result.
    const fcl::DistanceResult<S>& distance_at(const fcl::Transform3<S>& pose,
                                              const DistanceRequest& request,
                                              S below = std::numeric_limits<S>::max()) {
        nearest_.clear();
        nearest_.min_distance = below;
        fcl::distance<S>(model_.get(), fcl::Transform3<S>::Identity(), &copy(), pose, request,
                         nearest_);
        return nearest_;
    }
    const fcl::DistanceResult<S>& distance_at(std::size_t i, const DistanceRequest& request,
                                              S below = std::numeric_limits<S>::max()) {
        return distance_at(poses_[i], request, below);
    }
    S apart(Pair triangles, std::size_t i) const {
        fcl::Vector3<S> a[3], b[3], on_a, on_b;
        for (int k = 0; k < 3; ++k) {
            a[k] = model_->vertices[model_->tri_indices[triangles.a][k]];
            b[k] = copy().vertices[copy().tri_indices[triangles.b][k]];
        }
        return fcl::detail::TriangleDistance<S>::triDistance(a, b, poses_[i], on_a, on_b);
    }

  private:
    MeshOfFcl<S> mesh_, other_mesh_;
    fcl::CollisionResult<S> touches_;
    fcl::DistanceResult<S> nearest_;
};

/// How a model of these volumes is named.
template <class Volume> struct VolumeName {
    using S = typename Volume::S;
    static constexpr bool is_single = std::is_same_v<S, float>;
    static constexpr bool is_obb = std::is_same_v<Volume, fcl::OBB<S>>,
                          is_rss = std::is_same_v<Volume, fcl::RSS<S>>,
                          is_kios = std::is_same_v<Volume, fcl::kIOS<S>>;

    static std::string word() {
        const std::string name = is_obb ? "obb" : is_rss ? "rss" : is_kios ? "kios" : "obbrss";
        return name + (is_single ? "_f32" : "");
    }
    static std::string title() {
        return is_obb ? "OBB" : is_rss ? "RSS" : is_kios ? "kIOS" : "OBBRSS";
    }
};

/// The row of a contender by MeshModels<Volume>, called fcl.VOLUME and after; queries: what its
/// query does, from the word after "query = " on.
template <class Volume>
ContenderEntry entry_of_models(const std::string& after, const std::string& how,
                               const std::string& queries) {
    using Name = VolumeName<Volume>;
    ContenderEntry e;
    e.name = "fcl." + Name::word() + after;
    e.library = "fcl";
    e.summary = "FCL's BVHModel of " + Name::title() + (Name::is_single ? " in floats, " : ", ");
    e.summary += how;
    e.notes = "build = one model, which stands for the mesh and for its copy (two where that is "
              "larger), split at the mean, the default; query = " +
              queries +
              (Name::is_single ? "; floats, compiled here, to which poses are rounded; one thread"
                               : "; doubles, equal to the scene's floats; one thread");
    e.precision = Name::is_single ? "f32" : "f64";
    e.runs_on = RunsOn::one_thread;
    return e;
}

} // namespace boxwood::bench
