#include "bench/peers/answering.h"
#include "bench/peers/fcl/mesh_peers.h"
#include "bench/tasks/detail/mesh_pair_task.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>

#include <limits>
#include <memory>
#include <vector>

namespace boxwood::bench {
namespace {

/// One model, which stands for the mesh and for its copy.
template <class Volume> class MeshModels : public Contender {
  public:
    explicit MeshModels(const Job& job) : scene_(*job.scene) {
        for (const Vec3<float>& v : scene_.mesh.vertices)
            vertices_.emplace_back(static_cast<double>(v.x), static_cast<double>(v.y),
                                   static_cast<double>(v.z));
        for (const auto& [a, b, c] : scene_.mesh.triangles)
            triangles_.emplace_back(a, b, c);
        for (const Pose& pose : scene_.poses) {
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

template <class Volume> class FirstTouch final : public MeshModels<Volume> {
  public:
    FirstTouch(const Job& job, bool with_contact)
        : MeshModels<Volume>(job), request_(1, with_contact) {}
    void query(Answers& answers) override {
        std::vector<std::uint8_t>& touches = list_of<std::uint8_t>(answers);
        touches.clear();
        for (std::size_t i = 0; i < this->poses_.size(); ++i)
            touches.push_back(this->collide_at(i, request_) > 0);
    }

  private:
    fcl::CollisionRequestd request_;
};

template <class Volume> class AllTouches final : public MeshModels<Volume> {
  public:
    using MeshModels<Volume>::MeshModels;
    void query(Answers& answers) override {
        std::vector<PosedPair>& touching = list_of<PosedPair>(answers);
        touching.clear();
        for (std::size_t i = 0; i < this->poses_.size(); ++i) {
            this->collide_at(i, request_);
            for (std::size_t k = 0; k < this->result_.numContacts(); ++k) {
                const fcl::Contactd& contact = this->result_.getContact(k);
                touching.push_back({static_cast<std::uint32_t>(i),
                                    static_cast<std::uint32_t>(contact.b1),
                                    static_cast<std::uint32_t>(contact.b2)});
            }
        }
    }

  private:
    fcl::CollisionRequestd request_{std::numeric_limits<int>::max(), false};
};

template <class Volume> class LeastDistance final : public MeshModels<Volume> {
  public:
    using MeshModels<Volume>::MeshModels;
    void query(Answers& answers) override {
        std::vector<PosedDistance>& distances = list_of<PosedDistance>(answers);
        distances.clear();
        for (const fcl::Transform3d& pose : this->poses_) {
            result_.clear();
            const double d = fcl::distance<double>(this->model_.get(), fcl::Transform3d::Identity(),
                                                   this->model_.get(), pose, request_, result_);
            distances.push_back(
                {d,
                 d,
                 d,
                 {static_cast<std::uint32_t>(result_.b1), static_cast<std::uint32_t>(result_.b2)}});
        }
    }

  private:
    fcl::DistanceRequestd request_{true};
    fcl::DistanceResultd result_;
};

ContenderEntry entry_of(const std::string& name, const std::string& what, const std::string& how) {
    ContenderEntry e;
    e.name = "fcl." + name;
    e.library = "fcl";
    e.summary = fmt::format("FCL's BVHModel of {}, {}", what, how);
    e.notes = fmt::format("build = one model, which stands for the mesh and for its copy, split at "
                          "the mean, the default; query = {}, pose after pose, at the same model; "
                          "doubles, equal to the scene's floats; one thread",
                          how);
    e.precision = "f64";
    e.runs_on = RunsOn::one_thread;
    return e;
}

template <class Volume>
void append(std::vector<ContenderEntry>& all, const std::string& volume, const std::string& what,
            bool has_distance) {
    for (const bool with_contact : {false, true}) {
        ContenderEntry& e = all.emplace_back(
            entry_of(volume + (with_contact ? ".contact" : ""), what,
                     with_contact ? "collide for one contact, with its point and normal"
                                  : "collide for one contact, without its point"));
        e.answers = {answering<FirstTouch<Volume>>("collide", with_contact)};
    }
    ContenderEntry& every = all.emplace_back(
        entry_of(volume + ".all", what, "collide for all contacts, without their points"));
    every.answers = {answering<AllTouches<Volume>>("collide_all")};
    if (has_distance) {
        ContenderEntry& e =
            all.emplace_back(entry_of(volume + ".distance", what, "distance with nearest points"));
        e.answers = {answering<LeastDistance<Volume>>("distance")};
    }
}

} // namespace

std::vector<ContenderEntry> fcl_meshes() {
    std::vector<ContenderEntry> all;
    append<fcl::OBBRSSd>(all, "obbrss", "OBBRSS", true);
    append<fcl::OBBd>(all, "obb", "OBB", false);
    ContenderEntry& rss =
        all.emplace_back(entry_of("rss.distance", "RSS", "distance with nearest points"));
    rss.answers = {answering<LeastDistance<fcl::RSSd>>("distance")};
    return all;
}

} // namespace boxwood::bench
