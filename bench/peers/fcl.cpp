#include "bench/peers/answering.h"
#include "bench/peers/kernel_peers.h"
#include "bench/peers/point_peers.h"
#include "scenes/moving/frames.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/config.h>

#include <cstdint>

namespace boxwood::bench {
namespace {

using Object = fcl::CollisionObject<double>;

/// A geometry that is nothing but its bounds. FCL's own Box would be placed by centre and size, and
/// its bounds would come back rounded: other boxes than ours, other pairs at a touch.
class BoundsOnly final : public fcl::CollisionGeometry<double> {
  public:
    explicit BoundsOnly(const Aabb<float>& box) { take(box); }
    void take(const Aabb<float>& box) {
        aabb_local.min_ =
            fcl::Vector3<double>(static_cast<double>(box.min.x), static_cast<double>(box.min.y),
                                 static_cast<double>(box.min.z));
        aabb_local.max_ =
            fcl::Vector3<double>(static_cast<double>(box.max.x), static_cast<double>(box.max.y),
                                 static_cast<double>(box.max.z));
        computeLocalAABB();
    }
    void computeLocalAABB() override {
        aabb_center = aabb_local.center();
        aabb_radius = (aabb_local.max_ - aabb_center).norm();
    }
};

std::uint32_t item(const Object* object) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(object->getUserData()));
}

bool append(Object* a, Object* b, void* pairs) {
    static_cast<std::vector<Pair>*>(pairs)->push_back(ordered_pair(item(a), item(b)));
    return false; // go on
}

/// Manager: DynamicAABBTreeCollisionManager or its array twin.
template <class Manager> class FclContender final : public Contender {
  public:
    FclContender(const Job& job, Sides sides, bool moved_alone)
        : scene_(*job.scene), moved_alone_(moved_alone),
          between_halves_(sides == Sides::two_halves) {
        const std::vector<Aabb<float>>& boxes = scene_.boxes;
        const std::size_t split = between_halves_ ? tree_pairs_split(boxes.size()) : 0;
        is_present_.resize(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            bounds_.push_back(std::make_shared<BoundsOnly>(boxes[i]));
            auto object = std::make_unique<Object>(bounds_.back());
            object->setUserData(reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
            (i < split ? first_ : rest_).push_back(object.get());
            objects_.push_back(std::move(object));
        }
    }

    void build() override {
        if (std::exchange(moved_, false))
            for (std::size_t i = 0; i < objects_.size(); ++i)
                give(i, scene_.boxes[i]);
        for (std::size_t i = 0; i < objects_.size(); ++i)
            is_present_[i] = !scene_.boxes[i].is_empty();
        first_tree_ = make_tree(first_);
        rest_tree_ = make_tree(rest_);
    }

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        if (between_halves_)
            first_tree_->collide(rest_tree_.get(), &pairs, append);
        else
            rest_tree_->collide(&pairs, append);
    }

    void update(const Frame& now) override {
        moved_ = true;
        changed_.clear();
        for (const std::uint32_t i : now.moved) {
            Object* const object = objects_[i].get();
            const bool was_present = std::exchange(is_present_[i], !now.boxes[i].is_empty());
            if (!is_present_[i]) {
                rest_tree_->unregisterObject(object);
                continue;
            }
            give(i, now.boxes[i]);
            if (was_present)
                changed_.push_back(object);
            else
                rest_tree_->registerObject(object);
        }
        if (moved_alone_)
            rest_tree_->update(changed_);
        else
            rest_tree_->update();
    }

  private:
    void give(std::size_t i, const Aabb<float>& box) {
        if (box.is_empty())
            return;
        bounds_[i]->take(box);
        objects_[i]->computeAABB();
    }

    std::unique_ptr<Manager> make_tree(const std::vector<Object*>& objects) {
        auto tree = std::make_unique<Manager>();
        tree->tree_init_level = 2; // Morton order: a third of the build time of the default, 0
        changed_.clear();
        for (Object* const object : objects)
            if (is_present_[item(object)])
                changed_.push_back(object);
        tree->registerObjects(changed_);
        tree->setup();
        return tree;
    }

    const Scene& scene_;
    bool moved_alone_, between_halves_;
    bool moved_ = false;           ///< whether the boxes are those of a frame
    std::vector<char> is_present_; ///< by item
    std::vector<std::shared_ptr<BoundsOnly>> bounds_;
    std::vector<std::unique_ptr<Object>> objects_;
    std::vector<Object*> changed_;
    std::vector<Object*> first_, rest_; ///< all of them in `rest_` but for two halves
    std::unique_ptr<Manager> first_tree_, rest_tree_;
};

template <class Manager>
ContenderEntry entry(std::string name, std::string summary, bool moved_alone = false) {
    ContenderEntry e;
    e.name = std::move(name);
    e.library = "fcl";
    e.summary = std::move(summary);
    e.notes =
        "build = registerObjects in bulk + setup, tree_init_level 2 (Morton order: the fastest "
        "to build and no slower to query than the default median split); query = collide with a "
        "callback that appends the pair; boxes in double, equal to the scene's floats; one "
        "thread; a build also frees the tree before it";
    e.precision = "f64";
    e.notes += moved_alone ? "; a frame: boxes of the moved, update(moved)"
                           : "; a frame: boxes of the moved, update() of all";
    e.notes += "; bodies that come and go: registerObject, unregisterObject";
    e.runs_on = RunsOn::one_thread;
    e.answers =
        moved_alone
            ? std::vector{answering<FclContender<Manager>>("moving_pairs", Sides::all, true)}
            : answering_all_pairs<FclContender<Manager>>(false);
    return e;
}

} // namespace

Peer fcl_peer() {
    Peer peer;
    peer.name = "fcl";
    peer.title = "FCL";
    peer.summary = "Flexible Collision Library: broad phase by dynamic AABB trees";
    peer.version = FCL_VERSION;
    peer.build = "the distribution's package: double precision, no SSE";
    peer.contenders.push_back(entry<fcl::DynamicAABBTreeCollisionManager<double>>(
        "fcl.dynamic_aabb_tree", "FCL's DynamicAABBTreeCollisionManager"));
    peer.contenders.push_back(entry<fcl::DynamicAABBTreeCollisionManager_Array<double>>(
        "fcl.dynamic_aabb_tree_array",
        "FCL's DynamicAABBTreeCollisionManager_Array: nodes in one array"));
    peer.contenders.back().notes += "; FCL 0.7 loses the memory of the leaves at each bulk build";
    peer.contenders.push_back(entry<fcl::DynamicAABBTreeCollisionManager<double>>(
        "fcl.dynamic_aabb_tree.moved",
        "FCL's DynamicAABBTreeCollisionManager, given which objects moved", true));
    for (ContenderEntry& e : fcl_points())
        peer.contenders.push_back(std::move(e));
    for (ContenderEntry& e : fcl_kernels())
        peer.contenders.push_back(std::move(e));
    return peer;
}

} // namespace boxwood::bench
