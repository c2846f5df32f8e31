#include "bench/peers/point_peers.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <cstdint>

namespace boxwood::bench {
namespace {

using Object = fcl::CollisionObject<double>;
using Manager = fcl::DynamicAABBTreeCollisionManager<double>;

/// A geometry that is nothing but its bounds.
class Bounds final : public fcl::CollisionGeometry<double> {
  public:
    explicit Bounds(const Aabb<float>& box) {
        for (int axis = 0; axis < 3; ++axis) {
            aabb_local.min_[axis] = static_cast<double>(box.min[axis]);
            aabb_local.max_[axis] = static_cast<double>(box.max[axis]);
        }
        computeLocalAABB();
    }
    void computeLocalAABB() override {
        aabb_center = aabb_local.center();
        aabb_radius = (aabb_local.max_ - aabb_center).norm();
    }
};

std::vector<std::unique_ptr<Object>> objects_of(const std::vector<Aabb<float>>& boxes) {
    std::vector<std::unique_ptr<Object>> objects;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        objects.push_back(std::make_unique<Object>(std::make_shared<Bounds>(boxes[i])));
        objects.back()->setUserData(reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
    }
    return objects;
}

class AskManager final : public Contender {
  public:
    explicit AskManager(const Job& job)
        : scene_(*job.scene), ask_(job.task), k_(neighbours_of(scene_)),
          items_(objects_of(scene_.boxes)), queries_(objects_of(query_boxes(scene_, job.task))) {
        for (const std::unique_ptr<Object>& item : items_)
            registered_.push_back(item.get());
    }

    void build() override {
        tree_ = std::make_unique<Manager>();
        tree_->tree_init_level = 2;
        tree_->registerObjects(registered_);
        tree_->setup();
    }

    void query(Answers& answers) override {
        answers.pairs.clear();
        if (ask_ == Ask::nearest)
            answers.neighbours.resize(k_ * queries_.size());
        for (std::uint32_t i = 0; i < queries_.size(); ++i) {
            Asked asked{*this, i, answers.pairs, nullptr};
            if (ask_ != Ask::nearest) {
                tree_->collide(queries_[i].get(), &asked, append);
                continue;
            }
            NearestOfPeer nearest(std::span(answers.neighbours).subspan(i * k_, k_));
            asked.nearest = &nearest;
            tree_->distance(queries_[i].get(), &asked, offer);
        }
    }

  private:
    struct Asked {
        const AskManager& self;
        std::uint32_t query;
        std::vector<Pair>& pairs;
        NearestOfPeer* nearest;
    };

    /// The item of the two: the other is the query itself.
    static std::uint32_t item(const Asked& asked, const Object* a, const Object* b) {
        const Object* query = asked.self.queries_[asked.query].get();
        return static_cast<std::uint32_t>(
            reinterpret_cast<std::uintptr_t>((a == query ? b : a)->getUserData()));
    }
    static bool append(Object* a, Object* b, void* data) {
        const Asked& asked = *static_cast<const Asked*>(data);
        const Scene& scene = asked.self.scene_;
        const std::uint32_t i = item(asked, a, b);
        if (scene.spheres.empty() || meets(scene.spheres[asked.query], scene.boxes[i]))
            asked.pairs.push_back({asked.query, i});
        return false; // go on
    }
    static bool offer(Object* a, Object* b, void* data, double& worst) {
        const Asked& asked = *static_cast<const Asked*>(data);
        const Scene& scene = asked.self.scene_;
        const std::uint32_t i = item(asked, a, b);
        asked.nearest->offer({i, squared_distance(scene.points[asked.query], scene.boxes[i])});
        worst = std::sqrt(asked.nearest->worst());
        return worst == 0; // nothing can be nearer
    }

    const Scene& scene_;
    Ask ask_;
    std::size_t k_;
    std::vector<std::unique_ptr<Object>> items_, queries_;
    std::vector<Object*> registered_;
    std::unique_ptr<Manager> tree_;
};

} // namespace

std::vector<ContenderEntry> fcl_points() {
    ContenderEntry e;
    e.name = "fcl.dynamic_aabb_tree.object";
    e.library = "fcl";
    e.summary = "FCL's DynamicAABBTreeCollisionManager asked about one object after another";
    e.notes = "tree_init_level 2; query = collide (nearest: distance) of an object that is nothing "
              "but its bounds with a callback; balls go by their boxes and are tested in doubles "
              "by the callback; one thread";
    e.precision = "f64";
    e.unsupported = [](const Job& job) -> Unsupported {
        if (!is_point_ask(job.task) || job.task == Ask::closest_points)
            return "answers points, regions and nearest only";
        if (auto why = no_queries(job.scene, job.task))
            return why;
        return not_serial(job);
    };
    e.make = [](const Job& job) { return std::make_unique<AskManager>(job); };
    return {e};
}

} // namespace boxwood::bench
