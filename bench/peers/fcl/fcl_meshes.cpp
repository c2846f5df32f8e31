#include "bench/peers/answering.h"
#include "bench/peers/fcl/mesh_models.h"
#include "bench/peers/mesh_peers.h"
#include "bench/tasks/detail/median_distance.h"

#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace boxwood::bench {
namespace {

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

template <class Volume> class Nearer final : public MeshModels<Volume> {
  public:
    using MeshModels<Volume>::MeshModels;
    void query(Answers& answers) override {
        std::vector<std::uint8_t>& nearer = list_of<std::uint8_t>(answers);
        nearer.clear();
        for (const fcl::Transform3d& pose : this->poses_) {
            result_.clear();
            result_.min_distance = tolerance_; // what is not nearer is left out
            fcl::distance<double>(this->model_.get(), fcl::Transform3d::Identity(),
                                  this->model_.get(), pose, request_, result_);
            nearer.push_back(result_.b1 != fcl::DistanceResultd::NONE);
        }
    }

  private:
    double tolerance_ = median_distance(this->scene_);
    fcl::DistanceRequestd request_{false};
    fcl::DistanceResultd result_;
};

template <class Volume> class AllContacts final : public MeshModels<Volume> {
  public:
    using MeshModels<Volume>::MeshModels;
    void query(Answers& answers) override {
        std::vector<PosedContact>& found = list_of<PosedContact>(answers);
        found.clear();
        for (std::size_t i = 0; i < this->poses_.size(); ++i) {
            this->collide_at(i, request_);
            const auto first = static_cast<std::ptrdiff_t>(found.size());
            for (std::size_t k = 0; k < this->result_.numContacts(); ++k) {
                const fcl::Contactd& c = this->result_.getContact(k);
                found.push_back({{c.pos.x(), c.pos.y(), c.pos.z()},
                                 {c.normal.x(), c.normal.y(), c.normal.z()},
                                 c.penetration_depth,
                                 {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(c.b1),
                                  static_cast<std::uint32_t>(c.b2)}});
            }
            std::sort(found.begin() + first, found.end(), is_before);
        }
    }

  private:
    fcl::CollisionRequestd request_{std::numeric_limits<int>::max(), true};
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
void append_touches(std::vector<ContenderEntry>& all, const std::string& volume,
                    const std::string& what) {
    for (const bool with_contact : {false, true}) {
        ContenderEntry& e = all.emplace_back(
            entry_of(volume + (with_contact ? ".contact" : ""), what,
                     with_contact ? "collide for one contact, with its point and normal"
                                  : "collide for one contact, without its point"));
        e.answers = {answering<FirstTouch<Volume>>("collide", with_contact)};
        if (with_contact)
            e.classes = {with_contact_class};
    }
    ContenderEntry& every = all.emplace_back(
        entry_of(volume + ".all", what, "collide for all contacts, without their points"));
    every.answers = {answering<AllTouches<Volume>>("collide_all")};
    ContenderEntry& deepest = all.emplace_back(
        entry_of(volume + ".contacts", what,
                 "collide for all contacts, with points, normals and depths, and a sort by depth"));
    deepest.notes += "; up to two contacts of each pair of triangles";
    deepest.answers = {answering<AllContacts<Volume>>("contacts")};
}

template <class Volume>
void append_distances(std::vector<ContenderEntry>& all, const std::string& volume,
                      const std::string& what) {
    ContenderEntry& least =
        all.emplace_back(entry_of(volume + ".distance", what, "distance with nearest points"));
    least.answers = {answering<LeastDistance<Volume>>("distance")};
    ContenderEntry& nearer = all.emplace_back(
        entry_of(volume + ".tolerance", what,
                 "distance without nearest points, where the result starts at the tolerance, as "
                 "MoveIt does: what is farther is left out, and a nearer pair does not end it"));
    nearer.answers = {answering<Nearer<Volume>>("tolerance")};
}

} // namespace

std::vector<ContenderEntry> fcl_meshes() {
    std::vector<ContenderEntry> all;
    append_touches<fcl::OBBRSSd>(all, "obbrss", "OBBRSS");
    append_touches<fcl::OBBd>(all, "obb", "OBB");
    append_distances<fcl::OBBRSSd>(all, "obbrss", "OBBRSS");
    append_distances<fcl::RSSd>(all, "rss", "RSS");
    return all;
}

} // namespace boxwood::bench
