#include "bench/peers/coal/conversions.h"
#include "bench/peers/coal/module.h"
#include "bench/peers/mesh_queries.h"

#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/internal/intersect.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace boxwood::bench {
namespace {

/// Coal's model of the scene's mesh, which stands for the mesh and for its copy; as
/// bench/peers/mesh_queries.h asks of it.
template <class Volume> class MeshModels : public Contender {
  public:
    using S = coal::CoalScalar;
    using CollisionRequest = coal::CollisionRequest;
    using DistanceRequest = coal::DistanceRequest;

    explicit MeshModels(const Job& job)
        : mesh_(job.scene->mesh), other_mesh_(job.scene->other_copy) {
        for (const RigidTransform<double>& pose : job.scene->poses)
            poses_.push_back(transform_of(pose));
    }
    void build() override {
        model_.reset();
        other_.reset();
        model_ = mesh_.model<Volume>();
        if (!other_mesh_.triangles.empty())
            other_ = other_mesh_.model<Volume>();
    }

  protected:
    std::size_t n_poses() const { return poses_.size(); }
    std::size_t collide_at(std::size_t i, const CollisionRequest& request) {
        touches_.clear();
        return coal::collide(model_.get(), in_place_, &copy(), poses_[i], request, touches_);
    }
    template <class Visit> void for_each_contact(Visit visit) const {
        for (const coal::Contact& contact : touches_.getContacts())
            visit(contact);
    }
    /// Coal's depth is a signed distance, below 0 where the two overlap.
    static double depth_of(const coal::Contact& contact) { return -contact.penetration_depth; }
    const coal::DistanceResult& distance_at(std::size_t i, const DistanceRequest& request,
                                            S below = std::numeric_limits<S>::max()) {
        nearest_.clear();
        nearest_.min_distance = below;
        coal::distance(model_.get(), in_place_, &copy(), poses_[i], request, nearest_);
        return nearest_;
    }
    S apart(Pair triangles, std::size_t i) const {
        coal::Vec3s a[3], b[3], on_a, on_b;
        for (int k = 0; k < 3; ++k) {
            a[k] = (*model_->vertices)[(*model_->tri_indices)[triangles.a][k]];
            b[k] = poses_[i].transform((*copy().vertices)[(*copy().tri_indices)[triangles.b][k]]);
        }
        return std::sqrt(coal::TriangleDistance::sqrTriDistance(a, b, on_a, on_b));
    }

  private:
    const coal::BVHModel<Volume>& copy() const { return other_ ? *other_ : *model_; }

    MeshOfCoal mesh_, other_mesh_;
    std::vector<coal::Transform3s> poses_;
    coal::CollisionResult touches_;
    coal::DistanceResult nearest_;
    std::shared_ptr<coal::BVHModel<Volume>> model_, other_; ///< other_: of a copy of its own
    const coal::Transform3s in_place_;
};

constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

/// Where the two touch a signed distance would be asked for once more.
coal::DistanceRequest unsigned_distance() {
    coal::DistanceRequest request;
    request.enable_signed_distance = false;
    return request;
}

template <class Volume>
std::unique_ptr<Contender> mesh_contender(const Job& job, CoalMeshQuery query, double tolerance) {
    using Models = MeshModels<Volume>;
    switch (query) {
    case CoalMeshQuery::first_touch:
        return std::make_unique<FirstTouch<Models>>(job, request_of(1, false));
    case CoalMeshQuery::first_contact:
        return std::make_unique<FirstTouch<Models>>(job, request_of(1, true));
    case CoalMeshQuery::all_touches:
        return std::make_unique<AllTouches<Models>>(job, request_of(no_limit, false));
    case CoalMeshQuery::all_contacts:
        return std::make_unique<AllContacts<Models>>(job, request_of(no_limit, true));
    case CoalMeshQuery::least_distance:
        return std::make_unique<LeastDistance<Models>>(job, unsigned_distance());
    case CoalMeshQuery::warm_distance:
        return std::make_unique<WarmDistance<Models>>(job, unsigned_distance());
    case CoalMeshQuery::nearer:
        return std::make_unique<Nearer<Models>>(job, unsigned_distance(), tolerance);
    case CoalMeshQuery::within_margin:
        return std::make_unique<FirstTouch<Models>>(job, request_of(1, false, tolerance));
    }
    return nullptr;
}

} // namespace

std::unique_ptr<Contender> make_coal_meshes(const Job& job, CoalVolume volume, CoalMeshQuery query,
                                            double tolerance) {
    switch (volume) {
    case CoalVolume::obbrss:
        return mesh_contender<coal::OBBRSS>(job, query, tolerance);
    case CoalVolume::obb:
        return mesh_contender<coal::OBB>(job, query, tolerance);
    case CoalVolume::rss:
        return mesh_contender<coal::RSS>(job, query, tolerance);
    }
    return nullptr;
}

} // namespace boxwood::bench
