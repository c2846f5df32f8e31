#include "bench/peers/capability.h"
#include "bench/peers/kernel_peers.h"

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
    explicit BoundsOnly(const Aabb<float>& box) {
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
    explicit FclContender(const Job& job) {
        const std::vector<Aabb<float>>& boxes = job.scene->boxes;
        const std::size_t split = job.ask == Ask::tree_pairs ? tree_pairs_split(boxes.size()) : 0;
        between_halves_ = job.ask == Ask::tree_pairs;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            auto object = std::make_unique<Object>(std::make_shared<BoundsOnly>(boxes[i]));
            object->setUserData(reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
            (i < split ? first_ : rest_).push_back(object.get());
            objects_.push_back(std::move(object));
        }
    }

    void build() override {
        first_tree_ = make_tree(first_);
        rest_tree_ = make_tree(rest_);
    }

    void query(Answers& answers) override {
        answers.pairs.clear();
        if (between_halves_)
            first_tree_->collide(rest_tree_.get(), &answers.pairs, append);
        else
            rest_tree_->collide(&answers.pairs, append);
    }

  private:
    static std::unique_ptr<Manager> make_tree(const std::vector<Object*>& objects) {
        auto tree = std::make_unique<Manager>();
        tree->tree_init_level = 2; // Morton order: a third of the build time of the default, 0
        tree->registerObjects(objects);
        tree->setup();
        return tree;
    }

    bool between_halves_;
    std::vector<std::unique_ptr<Object>> objects_;
    std::vector<Object*> first_, rest_; ///< all of them in `rest_` for Ask::pairs
    std::unique_ptr<Manager> first_tree_, rest_tree_;
};

template <class Manager> ContenderEntry entry(std::string name, std::string summary) {
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
    e.unsupported = [](const Job& job) -> Unsupported {
        if (auto why = not_box_ask(job))
            return why;
        return not_serial(job);
    };
    e.make = [](const Job& job) { return std::make_unique<FclContender<Manager>>(job); };
    return e;
}

} // namespace

Peer fcl_peer() {
    Peer peer;
    peer.name = "fcl";
    peer.summary = "Flexible Collision Library: broad phase by dynamic AABB trees";
    peer.version = FCL_VERSION;
    peer.build = "the distribution's package: double precision, no SSE";
    peer.contenders.push_back(entry<fcl::DynamicAABBTreeCollisionManager<double>>(
        "fcl.dynamic_aabb_tree", "FCL's DynamicAABBTreeCollisionManager"));
    peer.contenders.push_back(entry<fcl::DynamicAABBTreeCollisionManager_Array<double>>(
        "fcl.dynamic_aabb_tree_array",
        "FCL's DynamicAABBTreeCollisionManager_Array: nodes in one array"));
    peer.contenders.back().notes += "; FCL 0.7 loses the memory of the leaves at each bulk build";
    for (ContenderEntry& e : fcl_kernels())
        peer.contenders.push_back(std::move(e));
    return peer;
}

} // namespace boxwood::bench
