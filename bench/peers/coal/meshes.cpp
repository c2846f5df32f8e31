#include "bench/peers/coal/module.h"
#include "bench/tasks/detail/mesh_pair_answers.h"

#include <coal/BVH/BVH_model.h>
#include <coal/collision.h>
#include <coal/distance.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

namespace boxwood::bench {
namespace {

/// Coal's model of the scene's mesh, which stands for the mesh and for its copy.
template <class Volume> class MeshModels : public Contender {
  public:
    explicit MeshModels(const Job& job) : scene_(*job.scene) {
        for (const Vec3<float>& v : scene_.mesh.vertices)
            vertices_.emplace_back(static_cast<double>(v.x), static_cast<double>(v.y),
                                   static_cast<double>(v.z));
        for (const auto& [a, b, c] : scene_.mesh.triangles)
            triangles_.emplace_back(a, b, c);
        for (const RigidTransform<double>& pose : scene_.poses) {
            coal::Matrix3s rotation;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    rotation(i, j) = pose.rotation[static_cast<std::size_t>(i)][j];
            const Vec3<double>& t = pose.translation;
            poses_.emplace_back(rotation, coal::Vec3s(t.x, t.y, t.z));
        }
    }
    void build() override {
        model_.reset();
        model_ = std::make_unique<coal::BVHModel<Volume>>();
        model_->beginModel(static_cast<unsigned>(triangles_.size()),
                           static_cast<unsigned>(vertices_.size()));
        model_->addSubModel(vertices_, triangles_);
        model_->endModel();
    }

  protected:
    const Scene& scene_;
    std::vector<coal::Transform3s> poses_;
    coal::CollisionResult result_;

    std::size_t collide_at(std::size_t i, const coal::CollisionRequest& request) {
        result_.clear();
        return coal::collide(model_.get(), in_place_, model_.get(), poses_[i], request, result_);
    }
    void distance_at(std::size_t i, const coal::DistanceRequest& request,
                     coal::DistanceResult& result) const {
        coal::distance(model_.get(), in_place_, model_.get(), poses_[i], request, result);
    }

  private:
    std::vector<coal::Vec3s> vertices_;
    std::vector<coal::Triangle> triangles_;
    std::unique_ptr<coal::BVHModel<Volume>> model_;
    const coal::Transform3s in_place_;
};

/// break_distance: boxes nearer than this are opened, so that a better lower bound of the distance
/// is found, which nobody reads here.
coal::CollisionRequest request_of(std::size_t max_contacts, bool with_contact, double margin = 0) {
    coal::CollisionRequest request;
    request.num_max_contacts = max_contacts;
    request.enable_contact = with_contact;
    request.security_margin = margin;
    request.break_distance = 0;
    return request;
}
constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

/// Yes or no for each pose: a touch, or nearer than a margin.
template <class Volume> class FirstTouch final : public MeshModels<Volume> {
  public:
    FirstTouch(const Job& job, bool with_contact, double margin = 0)
        : MeshModels<Volume>(job), request_(request_of(1, with_contact, margin)) {}
    void query(Answers& answers) override {
        std::vector<std::uint8_t>& touches = list_of<std::uint8_t>(answers);
        touches.clear();
        for (std::size_t i = 0; i < this->poses_.size(); ++i)
            touches.push_back(this->collide_at(i, request_) > 0);
    }

  private:
    coal::CollisionRequest request_;
};

PosedPair pair_of(std::size_t pose, const coal::Contact& contact) {
    return {static_cast<std::uint32_t>(pose), static_cast<std::uint32_t>(contact.b1),
            static_cast<std::uint32_t>(contact.b2)};
}

template <class Volume> class AllTouches final : public MeshModels<Volume> {
  public:
    using MeshModels<Volume>::MeshModels;
    void query(Answers& answers) override {
        std::vector<PosedPair>& touching = list_of<PosedPair>(answers);
        touching.clear();
        for (std::size_t i = 0; i < this->poses_.size(); ++i) {
            this->collide_at(i, request_);
            for (const coal::Contact& contact : this->result_.getContacts())
                touching.push_back(pair_of(i, contact));
        }
    }

  private:
    coal::CollisionRequest request_ = request_of(no_limit, false);
};

/// Coal's depth is a signed distance, below 0 where the two overlap.
template <class Volume> class AllContacts final : public MeshModels<Volume> {
  public:
    using MeshModels<Volume>::MeshModels;
    void query(Answers& answers) override {
        std::vector<PosedContact>& found = list_of<PosedContact>(answers);
        found.clear();
        for (std::size_t i = 0; i < this->poses_.size(); ++i) {
            this->collide_at(i, request_);
            const auto first = static_cast<std::ptrdiff_t>(found.size());
            for (const coal::Contact& c : this->result_.getContacts())
                found.push_back({{c.pos.x(), c.pos.y(), c.pos.z()},
                                 {c.normal.x(), c.normal.y(), c.normal.z()},
                                 -c.penetration_depth,
                                 pair_of(i, c)});
            std::sort(found.begin() + first, found.end(), is_before);
        }
    }

  private:
    coal::CollisionRequest request_ = request_of(no_limit, true);
};

/// Where the two touch a signed distance would be asked for once more.
coal::DistanceRequest unsigned_distance() {
    coal::DistanceRequest request;
    request.enable_signed_distance = false;
    return request;
}

template <class Volume> class LeastDistance final : public MeshModels<Volume> {
  public:
    using MeshModels<Volume>::MeshModels;
    void query(Answers& answers) override {
        std::vector<PosedDistance>& distances = list_of<PosedDistance>(answers);
        distances.clear();
        for (std::size_t i = 0; i < this->poses_.size(); ++i) {
            result_.clear();
            this->distance_at(i, request_, result_);
            const double d = result_.min_distance;
            distances.push_back(
                {d,
                 d,
                 d,
                 {static_cast<std::uint32_t>(result_.b1), static_cast<std::uint32_t>(result_.b2)}});
        }
    }

  private:
    coal::DistanceRequest request_ = unsigned_distance();
    coal::DistanceResult result_;
};

template <class Volume>
std::unique_ptr<Contender> mesh_contender(const Job& job, CoalMeshQuery query, double tolerance) {
    switch (query) {
    case CoalMeshQuery::first_touch:
        return std::make_unique<FirstTouch<Volume>>(job, false);
    case CoalMeshQuery::first_contact:
        return std::make_unique<FirstTouch<Volume>>(job, true);
    case CoalMeshQuery::all_touches:
        return std::make_unique<AllTouches<Volume>>(job);
    case CoalMeshQuery::all_contacts:
        return std::make_unique<AllContacts<Volume>>(job);
    case CoalMeshQuery::least_distance:
        return std::make_unique<LeastDistance<Volume>>(job);
    case CoalMeshQuery::within_margin:
        return std::make_unique<FirstTouch<Volume>>(job, false, tolerance);
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
