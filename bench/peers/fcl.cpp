#include "bench/peers/answering.h"
#include "bench/peers/comers.h"
#include "bench/peers/fcl_bounds.h"
#include "bench/peers/kernel_peers.h"
#include "bench/peers/point_peers.h"
#include "bench/tasks/moving_pairs.h"
#include "scenes/moving/frames.h"

#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/broadphase/broadphase_interval_tree.h>
#include <fcl/broadphase/broadphase_spatialhash.h>
#include <fcl/config.h>
#include <fmt/format.h>

namespace boxwood::bench {
namespace {

template <class S> using Broadphase = fcl::BroadPhaseCollisionManager<S>;
template <class S> using Tree = fcl::DynamicAABBTreeCollisionManager<S>;
template <class S> using TreeArray = fcl::DynamicAABBTreeCollisionManager_Array<S>;
using Hash = fcl::SpatialHashingCollisionManager<double>;
using Interval = fcl::IntervalTreeCollisionManager<double>;
using Sap = fcl::SaPCollisionManager<double>;
using SimpleSap = fcl::SSaPCollisionManager<double>;

/// What a frame tells the manager.
enum class Told : std::uint8_t {
    all_may_have_moved, ///< update()
    which_moved         ///< update(moved)
};

/// The cells have the mean of the boxes' longest sides. Of the limits only the numbers of the cells
/// depend: three times as wide, boxes may leave the scene without being kept in lists.
std::unique_ptr<Broadphase<double>> hash_for(const std::vector<Aabb<float>>& boxes) {
    fcl::AABB<double> limits(fcl::Vector3<double>::Zero());
    double sides = 0;
    std::size_t present = 0;
    for (const Aabb<float>& box : boxes) {
        if (box.is_empty())
            continue;
        const fcl::AABB<double> bounds = FclBounds<double>(box).aabb_local;
        limits = present++ ? limits + bounds : bounds;
        sides += (bounds.max_ - bounds.min_).maxCoeff();
    }
    const fcl::Vector3<double> extent = limits.max_ - limits.min_;
    const double tenth = extent.maxCoeff() / 10;
    const double cell = sides > 0 ? sides / static_cast<double>(present) : std::max(tenth, 1.0);
    const fcl::Vector3<double> room = extent + fcl::Vector3<double>::Constant(cell);
    return std::make_unique<Hash>(cell, limits.min_ - room, limits.max_ + room,
                                  static_cast<unsigned>(std::max<std::size_t>(present, 1)));
}

template <class S>
bool append(fcl::CollisionObject<S>* a, fcl::CollisionObject<S>* b, void* pairs) {
    static_cast<std::vector<Pair>*>(pairs)->push_back(ordered_pair(item_of(a), item_of(b)));
    return false; // go on
}

/// For the hash, which gives all that share a cell.
bool append_overlapping(fcl::CollisionObject<double>* a, fcl::CollisionObject<double>* b,
                        void* pairs) {
    return a->getAABB().overlap(b->getAABB()) && append(a, b, pairs);
}

template <class S> struct Kind {
    /// An empty manager for a scene of these boxes.
    std::unique_ptr<Broadphase<S>> (*make)(const std::vector<Aabb<float>>& boxes);
    Told told = Told::all_may_have_moved;
    fcl::CollisionCallBack<S> callback = append<S>;
};

template <class S> class FclContender final : public Contender {
    using Object = fcl::CollisionObject<S>;

  public:
    FclContender(const Job& job, Sides sides, Kind<S> kind)
        : scene_(*job.scene), kind_(kind), between_halves_(sides == Sides::two_halves) {
        const std::vector<Aabb<float>>& boxes = scene_.boxes;
        const std::size_t split = between_halves_ ? tree_pairs_split(boxes.size()) : 0;
        is_present_.resize(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            bounds_.push_back(std::make_shared<FclBounds<S>>(boxes[i]));
            objects_.push_back(fcl_object(bounds_.back(), i));
            (i < split ? first_ : rest_).push_back(objects_.back().get());
        }
    }

    void build() override {
        if (std::exchange(moved_, false))
            for (std::size_t i = 0; i < objects_.size(); ++i)
                give(i, scene_.boxes[i]);
        for (std::size_t i = 0; i < objects_.size(); ++i)
            is_present_[i] = !scene_.boxes[i].is_empty();
        first_manager_ = make_manager(first_);
        rest_manager_ = make_manager(rest_);
    }

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        if (between_halves_)
            first_manager_->collide(rest_manager_.get(), &pairs, kind_.callback);
        else
            rest_manager_->collide(&pairs, kind_.callback);
    }

    void update(const Frame& now) override {
        moved_ = true;
        changed_.clear();
        for (const std::uint32_t i : now.moved) {
            Object* const object = objects_[i].get();
            const bool was_present = std::exchange(is_present_[i], !now.boxes[i].is_empty());
            if (!is_present_[i]) {
                rest_manager_->unregisterObject(object);
                continue;
            }
            give(i, now.boxes[i]);
            if (was_present)
                changed_.push_back(object);
            else
                rest_manager_->registerObject(object);
        }
        if (kind_.told == Told::which_moved)
            rest_manager_->update(changed_);
        else
            rest_manager_->update();
    }

  private:
    void give(std::size_t i, const Aabb<float>& box) {
        if (box.is_empty())
            return;
        bounds_[i]->take(box);
        objects_[i]->computeAABB();
    }

    std::unique_ptr<Broadphase<S>> make_manager(const std::vector<Object*>& objects) {
        std::unique_ptr<Broadphase<S>> manager = kind_.make(scene_.boxes);
        changed_.clear();
        for (Object* const object : objects)
            if (is_present_[item_of(object)])
                changed_.push_back(object);
        manager->registerObjects(changed_);
        manager->setup();
        return manager;
    }

    const Scene& scene_;
    Kind<S> kind_;
    bool between_halves_;
    bool moved_ = false;           ///< whether the boxes are those of a frame
    std::vector<char> is_present_; ///< by item
    std::vector<std::shared_ptr<FclBounds<S>>> bounds_;
    std::vector<std::unique_ptr<Object>> objects_;
    std::vector<Object*> changed_;
    std::vector<Object*> first_, rest_; ///< all of them in `rest_` but for two halves
    std::unique_ptr<Broadphase<S>> first_manager_, rest_manager_;
};

template <class M, class S> std::unique_ptr<Broadphase<S>> plain(const std::vector<Aabb<float>>&) {
    return std::make_unique<M>();
}

/// In Morton order.
template <class M, class S> std::unique_ptr<Broadphase<S>> tree(const std::vector<Aabb<float>>&) {
    auto made = std::make_unique<M>();
    made->tree_init_level = 2;
    return made;
}

template <class S>
ContenderEntry entry(std::string name, std::string summary, std::string notes, Kind<S> kind) {
    ContenderEntry e;
    e.name = "fcl." + std::move(name);
    e.library = "fcl";
    e.summary = "FCL's " + std::move(summary);
    e.precision = std::is_same_v<S, float> ? "f32" : "f64";
    e.notes = std::move(notes) +
              fmt::format("query = collide with a callback that appends the pair; boxes in {}; one "
                          "thread; a build also frees what was built before; a frame: boxes of the "
                          "moved, {}; bodies that come and go: registerObject, unregisterObject",
                          e.precision == "f32" ? "float, compiled here"
                                               : "double, equal to the scene's floats",
                          kind.told == Told::which_moved ? "update(moved)" : "update() of all");
    e.runs_on = RunsOn::one_thread;
    e.answers = answering_all_pairs<FclContender<S>>(kind);
    return e;
}

ContenderEntry only_for(std::string_view task, ContenderEntry e) {
    std::erase_if(e.answers, [&](const Answering& answering) { return answering.task != task; });
    return e;
}

template <class S, class M>
void add_trees(std::vector<ContenderEntry>& all, const std::string& name,
               const std::string& summary) {
    const std::string build = "build = registerObjects in bulk + setup, tree_init_level 2 (Morton "
                              "order: the fastest to build and no slower to query than the default "
                              "median split); ";
    all.push_back(entry<S>(name, summary, build, {tree<M, S>}));
    all.push_back(
        only_for("moving_pairs", entry<S>(name + ".moved", summary + ", given which objects moved",
                                          build, {tree<M, S>, Told::which_moved})));
}

std::optional<std::string> cannot_unregister(const Job& job) {
    if (has_comers(job))
        return "FCL 0.7 cannot take out objects here: its SaP reads a place in a list that it has "
               "erased, its interval tree goes round for ever";
    return std::nullopt;
}

/// The managers without a tree of boxes. But for SSaP they may miss pairs that only touch: end
/// points that are equal come in any order, and a box that ends where a cell begins is not in it.
void add_others(std::vector<ContenderEntry>& all) {
    const std::size_t first = all.size();
    const std::string build = "build = registerObjects + setup";
    const auto sap = [&](std::string name) {
        ContenderEntry e = entry<double>(
            std::move(name),
            "SaPCollisionManager: sorted end points, and the pairs that they tell, kept",
            build + ", which finds the pairs by a sweep along one axis; ",
            {plain<Sap, double>, Told::which_moved});
        e.answers_from_cache = true;
        return e;
    };
    all.push_back(only_for("pairs", sap("sap")));
    all.push_back(only_for("moving_pairs", sap("sap.moved")));
    all.back().classes = {cached_pairs_class};
    all.back().cannot = cannot_unregister;
    all.push_back(entry<double>("interval_tree",
                                "IntervalTreeCollisionManager: end points swept along one axis",
                                build + "; ", {plain<Interval, double>}));
    all.back().cannot = cannot_unregister;
    std::erase_if(all.back().answers, // it gives each pair of two managers twice
                  [](const Answering& answering) { return answering.task == "tree_pairs"; });
    all.push_back(entry<double>(
        "spatial_hash", "SpatialHashingCollisionManager: a hash table of cells",
        build + "; cells of the boxes' mean longest side, as many slots as boxes; the callback "
                "compares the boxes; ",
        {hash_for, Told::all_may_have_moved, append_overlapping}));
    for (std::size_t i = first; i < all.size(); ++i) {
        all[i].notes += "; may miss pairs that only touch";
        all[i].misses_touching = true;
    }
    all.push_back(entry<double>(
        "ssap", "SSaPCollisionManager: objects sorted by their minima, swept along one axis",
        build + "; ", {plain<SimpleSap, double>}));
}

} // namespace

Peer fcl_peer() {
    Peer peer;
    peer.name = "fcl";
    peer.title = "FCL";
    peer.summary = "Flexible Collision Library: broad phase by dynamic AABB trees";
    peer.version = FCL_VERSION;
    peer.build = "the distribution's package: double precision, no SSE; floats compiled here";
    std::vector<ContenderEntry>& all = peer.contenders;
    add_trees<double, Tree<double>>(all, "dynamic_aabb_tree", "DynamicAABBTreeCollisionManager");
    add_trees<float, Tree<float>>(all, "dynamic_aabb_tree_f32",
                                  "DynamicAABBTreeCollisionManager in floats");
    add_trees<double, TreeArray<double>>(
        all, "dynamic_aabb_tree_array",
        "DynamicAABBTreeCollisionManager_Array: nodes in one array");
    add_trees<float, TreeArray<float>>(all, "dynamic_aabb_tree_array_f32",
                                       "DynamicAABBTreeCollisionManager_Array in floats");
    add_others(all);
    for (ContenderEntry& e : fcl_points())
        all.push_back(std::move(e));
    for (ContenderEntry& e : fcl_kernels())
        all.push_back(std::move(e));
    return peer;
}

} // namespace boxwood::bench
