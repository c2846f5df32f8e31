#include "bench/peers/replay_peers.h"
#include "bench/replay/replayer.h"
#include "trees/adapters/apis/fcl_api.h"

#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

namespace boxwood::bench {
namespace by_bounds {
namespace {

template <class S> using Managers = std::unique_ptr<fcl::BroadPhaseCollisionManager<S>>;

template <class M, class S> Managers<S> plain() { return std::make_unique<M>(); }

/// level: 0 splits at the median, from the top; 2 in Morton order.
template <class M, class S, int level> Managers<S> tree() {
    auto made = std::make_unique<M>();
    made->tree_init_level = level;
    return made;
}

using Doubles = Managers<double> (*)();
using Floats = Managers<float> (*)();

/// What FCL 0.7 does not come back from.
enum class Ends : std::uint8_t {
    always,
    where_bounds_are_near,
    without_distances ///< SSaP looks for ever for what is near its only object
};
bool is_stood(Ends ends, const RecordedProgram& program) {
    if (ends == Ends::without_distances &&
        std::ranges::any_of(program.calls, [](const RecordedProgram::Call& call) {
            return is_distance(call.what);
        }))
        return false;
    return ends == Ends::always || program.has_near_bounds();
}

/// In the numbers of the program.
ReplayEntry entry(std::string name, std::string library, std::string summary, Doubles in_doubles,
                  Floats in_floats, Ends ends = Ends::where_bounds_are_near) {
    const auto make = [=](const RecordedProgram& program) -> std::unique_ptr<Replay> {
        if (!is_stood(ends, program))
            return nullptr;
        if (program.bits == 32)
            return std::make_unique<Replayer<FclApi<float>>>(program, in_floats);
        return std::make_unique<Replayer<FclApi<double>>>(program, in_doubles);
    };
    return {.name = std::move(name),
            .library = std::move(library),
            .summary = std::move(summary),
            .make = make};
}

} // namespace
} // namespace by_bounds

std::vector<ReplayEntry> fcl_replays() {
    using by_bounds::entry, by_bounds::plain, by_bounds::tree, by_bounds::Ends;
    using fcl::DynamicAABBTreeCollisionManager, fcl::DynamicAABBTreeCollisionManager_Array,
        fcl::SSaPCollisionManager, fcl::NaiveCollisionManager;
    std::vector<ReplayEntry> all = {
        entry(
            "boxwood.fcl_manager", "boxwood", "boxwood::FclBroadPhase, in place of FCL's managers",
            plain<FclBroadPhase<double>, double>, plain<FclBroadPhase<float>, float>, Ends::always),
        entry("fcl.dynamic_aabb_tree", "fcl",
              "DynamicAABBTreeCollisionManager, split at the median, its default",
              tree<DynamicAABBTreeCollisionManager<double>, double, 0>,
              tree<DynamicAABBTreeCollisionManager<float>, float, 0>),
        entry("fcl.dynamic_aabb_tree.morton", "fcl",
              "DynamicAABBTreeCollisionManager, tree_init_level 2: in Morton order",
              tree<DynamicAABBTreeCollisionManager<double>, double, 2>,
              tree<DynamicAABBTreeCollisionManager<float>, float, 2>),
        entry("fcl.dynamic_aabb_tree_array", "fcl",
              "DynamicAABBTreeCollisionManager_Array, split at the median, its default",
              tree<DynamicAABBTreeCollisionManager_Array<double>, double, 0>,
              tree<DynamicAABBTreeCollisionManager_Array<float>, float, 0>),
        entry("fcl.dynamic_aabb_tree_array.morton", "fcl",
              "DynamicAABBTreeCollisionManager_Array, tree_init_level 2: in Morton order",
              tree<DynamicAABBTreeCollisionManager_Array<double>, double, 2>,
              tree<DynamicAABBTreeCollisionManager_Array<float>, float, 2>),
        entry("fcl.ssap", "fcl", "SSaPCollisionManager: objects sorted by their minima",
              plain<SSaPCollisionManager<double>, double>,
              plain<SSaPCollisionManager<float>, float>, Ends::without_distances),
        entry("fcl.naive", "fcl", "NaiveCollisionManager: all pairs",
              plain<NaiveCollisionManager<double>, double>,
              plain<NaiveCollisionManager<float>, float>, Ends::always)};
    all.back().is_truth = true;
    return all;
}

} // namespace boxwood::bench
