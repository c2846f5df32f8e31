#include "bench/peers/answering.h"
#include "bench/peers/comers.h"
#include "bench/peers/fcl/fcl_bounds.h"
#include "bench/peers/kernel_peers.h"
#include "bench/peers/mesh_peers.h"
#include "bench/peers/point_peers.h"
#include "bench/peers/replay_peers.h"
#include "bench/tasks/moving_pairs.h"

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

std::unique_ptr<Broadphase<double>> hash_for(const std::vector<Aabb<float>>& boxes) {
    const HashGrid grid = hash_grid(boxes);
    const Aabb<double>& within = grid.limits;
    return std::make_unique<Hash>(
        grid.cell, fcl::Vector3<double>(within.min.x, within.min.y, within.min.z),
        fcl::Vector3<double>(within.max.x, within.max.y, within.max.z), grid.slots);
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
    using Object = fcl::CollisionObject<S>;
    using Manager = Broadphase<S>;
    using Bounds = FclBounds<S>;

    std::unique_ptr<Manager> (*make)(const std::vector<Aabb<float>>& boxes);
    Reported reported = Reported::all_may_have_moved;
    fcl::CollisionCallBack<S> callback = append<S>;

    void collide(Manager& manager, std::vector<Pair>& pairs) const {
        manager.collide(&pairs, callback);
    }
    void collide(Manager& manager, Manager& other, std::vector<Pair>& pairs) const {
        manager.collide(&other, &pairs, callback);
    }
};

template <class M, class S> std::unique_ptr<Broadphase<S>> plain(const std::vector<Aabb<float>>&) {
    return std::make_unique<M>();
}

/// level: 0 splits at the median, from the top; 2 in Morton order.
template <class M, class S, int level>
std::unique_ptr<Broadphase<S>> tree(const std::vector<Aabb<float>>&) {
    auto made = std::make_unique<M>();
    made->tree_init_level = level;
    return made;
}

template <class S>
ContenderEntry entry(std::string name, std::string summary, std::string notes, Kind<S> kind) {
    ContenderEntry e;
    e.name = "fcl." + std::move(name);
    e.library = "fcl";
    e.summary = "FCL's " + std::move(summary);
    e.precision = std::is_same_v<S, float> ? "f32" : "f64";
    e.notes =
        std::move(notes) +
        fmt::format("query = collide with a callback that appends the pair; boxes in {}; one "
                    "thread; a build also frees what was built before; a frame: boxes of the "
                    "moved, {}; bodies that come and go: registerObject, unregisterObject",
                    e.precision == "f32" ? "float, compiled here"
                                         : "double, equal to the scene's floats",
                    kind.reported == Reported::which_moved ? "update(moved)" : "update() of all");
    e.runs_on = RunsOn::one_thread;
    e.answers = answering_all_pairs<ManagerContender<Kind<S>>>(kind);
    return e;
}

ContenderEntry only_for(std::string_view task, ContenderEntry e) {
    std::erase_if(e.answers, [&](const Answering& answering) { return answering.task != task; });
    return e;
}

template <class S, class M>
void add_trees(std::vector<ContenderEntry>& all, const std::string& name,
               const std::string& summary) {
    const auto add = [&](const std::string& setting, const std::string& said,
                         const std::string& level, auto make) {
        const std::string build = "build = registerObjects in bulk + setup, " + level + "; ";
        all.push_back(entry<S>(name + setting, summary + said, build, {make}));
        all.push_back(
            only_for("moving_pairs", entry<S>(name + setting + ".moved",
                                              summary + said + ", given which objects moved", build,
                                              {make, Reported::which_moved})));
    };
    add("", "", "tree_init_level 2 (Morton order: the faster to build)", tree<M, S, 2>);
    add(".median", ", split at the median",
        "tree_init_level 0 (the default: from the top, at the median)", tree<M, S, 0>);
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
            {plain<Sap, double>, Reported::which_moved});
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
        {hash_for, Reported::all_may_have_moved, append_overlapping}));
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
    for (const auto more : {fcl_meshes, fcl_motions, fcl_robots})
        for (ContenderEntry& e : more())
            all.push_back(std::move(e));
    for (const auto more : {fcl_kernels, fcl_shapes})
        for (ContenderEntry& e : more())
            all.push_back(std::move(e));
    peer.replays = fcl_replays();
    for (ReplayEntry& e : fcl_shape_replays())
        peer.replays.push_back(std::move(e));
    return peer;
}

} // namespace boxwood::bench
