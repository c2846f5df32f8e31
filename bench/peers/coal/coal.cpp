#include "bench/peers/coal/module.h"
#include "bench/peers/comers.h"
#include "bench/tasks/detail/median_distance.h"
#include "bench/tasks/detail/mesh_pair_answers.h"
#include "bench/tasks/moving_pairs.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace boxwood::bench {
namespace {

/// Opened once and kept: what it made may outlive any one caller.
const CoalModule& module() {
    static const CoalModule* const opened = [] {
        void* const door = dlopen(BOXWOOD_COAL_MODULE, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
        const void* const found = door ? dlsym(door, coal_module_symbol) : nullptr;
        if (!found)
            throw std::runtime_error(fmt::format("the peer coal cannot be opened: {}", dlerror()));
        return static_cast<const CoalModule*>(found);
    }();
    return *opened;
}

ContenderEntry row(std::string name, std::string summary, std::string notes) {
    ContenderEntry e;
    e.name = "coal." + std::move(name);
    e.library = "coal";
    e.summary = "Coal's " + std::move(summary);
    e.notes = std::move(notes);
    e.precision = "f64";
    e.runs_on = RunsOn::one_thread;
    return e;
}

ContenderEntry manager(std::string name, std::string summary, const std::string& build,
                       CoalManager kind, Reported reported = Reported::all_may_have_moved) {
    ContenderEntry e =
        row(std::move(name), std::move(summary),
            fmt::format("{}; query = collide with a callback that appends the pair; boxes in "
                        "double, equal to the scene's floats; one thread; a build also frees what "
                        "was built before; a frame: boxes of the moved, {}; bodies that come and "
                        "go: registerObject, unregisterObject",
                        build,
                        reported == Reported::which_moved ? "update(moved)" : "update() of all"));
    const auto answers = [kind, reported](std::string task, Sides sides) {
        return Answering{std::move(task), [=](const Job& job) {
                             return module().manager(job, sides, kind, reported);
                         }};
    };
    if (reported == Reported::all_may_have_moved)
        e.answers = {answers("pairs", Sides::all), answers("tree_pairs", Sides::two_halves)};
    e.answers.push_back(answers("moving_pairs", Sides::all));
    return e;
}

std::vector<ContenderEntry> managers() {
    const std::string build = "build = registerObjects + setup";
    std::vector<ContenderEntry> all;
    const auto add_tree = [&](const std::string& name, const std::string& summary,
                              const std::string& level, CoalManager kind) {
        const std::string in_bulk = "build = registerObjects in bulk + setup, " + level;
        all.push_back(manager(name, summary, in_bulk, kind));
        all.push_back(manager(name + ".moved", summary + ", given which objects moved", in_bulk,
                              kind, Reported::which_moved));
    };
    const std::string tree = "DynamicAABBTreeCollisionManager",
                      array = "DynamicAABBTreeArrayCollisionManager: nodes in one array",
                      morton = "tree_init_level 2 (Morton order: the faster to build)",
                      median = "tree_init_level 0 (the default: from the top, at the median)";
    add_tree("dynamic_aabb_tree", tree, morton, CoalManager::tree);
    add_tree("dynamic_aabb_tree.median", tree + ", split at the median", median,
             CoalManager::tree_median);
    add_tree("dynamic_aabb_tree_array", array, morton, CoalManager::tree_array);
    add_tree("dynamic_aabb_tree_array.median", array + ", split at the median", median,
             CoalManager::tree_array_median);
    all.push_back(manager("ssap",
                          "SSaPCollisionManager: objects sorted by their minima, one axis swept",
                          build, CoalManager::ssap));
    const std::size_t exact = all.size();
    all.push_back(manager("sap", "SaPCollisionManager: sorted end points, and the pairs they tell",
                          build + ", which finds the pairs", CoalManager::sap));
    all.back().answers_from_cache = true;
    all.push_back(manager("interval_tree",
                          "IntervalTreeCollisionManager: end points swept along one axis", build,
                          CoalManager::interval_tree));
    all.push_back(manager("spatial_hash", "SpatialHashingCollisionManager: a hash table of cells",
                          build + "; cells of the boxes' mean longest side, as many slots as "
                                  "boxes; the callback compares the boxes",
                          CoalManager::hash));
    for (std::size_t i = exact; i < all.size(); ++i) { // as FCL's, of which they come
        all[i].answers.resize(1);                      // "pairs"
        all[i].notes += "; may miss pairs that only touch";
        all[i].misses_touching = true;
    }
    return all;
}

ContenderEntry kernel(std::string name, std::string task, std::string summary, std::string notes,
                      CoalKernel kind) {
    ContenderEntry e = row(std::move(name), std::move(summary), std::move(notes));
    e.kernel = e.name;
    e.answers = {{std::move(task), [kind](const Job& job) { return module().kernel(job, kind); }}};
    return e;
}

/// By each form of Coal's GJK.
void append_shapes(std::vector<ContenderEntry>& all) {
    struct Form {
        const char *after, *notes;
        CoalGjk gjk;
    };
    constexpr Form forms[] = {
        {"", "", CoalGjk::plain},
        {".polyak", "gjk_variant PolyakAcceleration; ", CoalGjk::polyak},
        {".nesterov", "gjk_variant NesterovAcceleration; ", CoalGjk::nesterov}};
    struct Query {
        const char *name, *task, *summary, *notes;
        CoalShapeQuery query;
    };
    constexpr Query queries[] = {
        {"shapes.collide", "shape_collide", "ComputeCollision on two shapes, enable_contact off",
         "distance_upper_bound 0; ", CoalShapeQuery::collide},
        {"shapes.distance", "shape_distance", "ComputeDistance on two shapes, not signed", "",
         CoalShapeQuery::distance},
        {"shapes.signed_distance", "signed_shape_distance",
         "ComputeDistance on two shapes, signed, its default", "",
         CoalShapeQuery::signed_distance}};
    for (const Query& of : queries)
        for (const Form& form : forms) {
            ContenderEntry& e = all.emplace_back(
                row(std::string(of.name) + form.after, of.summary,
                    std::string(form.notes) + of.notes +
                        "default tolerances (1e-6); kept for each pair, one call each"));
            e.kernel = e.name;
            e.answers = {{of.task, [query = of.query, gjk = form.gjk](const Job& job) {
                              return module().shapes(job, query, gjk);
                          }}};
        }
}

struct MeshRow {
    const char* name;
    const char* task;
    const char* how;
    CoalVolume volume;
    CoalMeshQuery query;
};
constexpr const char* warm = "distance, not signed, where the result starts at how far the "
                             "triangles of the answer before are apart in the new pose";
constexpr const char* from_tolerance = "distance, not signed, where the result starts at the "
                                       "tolerance: what is farther is left out, and a nearer pair "
                                       "does not end it";
constexpr MeshRow mesh_rows[] = {
    {"obbrss", "collide", "collide for one contact, enable_contact off", CoalVolume::obbrss,
     CoalMeshQuery::first_touch},
    {"obbrss.contact", "collide", "collide for one contact, enable_contact on, its default",
     CoalVolume::obbrss, CoalMeshQuery::first_contact},
    {"obb", "collide", "collide for one contact, enable_contact off", CoalVolume::obb,
     CoalMeshQuery::first_touch},
    {"obbrss.all", "collide_all", "collide for all contacts, enable_contact off",
     CoalVolume::obbrss, CoalMeshQuery::all_touches},
    {"obb.all", "collide_all", "collide for all contacts, enable_contact off", CoalVolume::obb,
     CoalMeshQuery::all_touches},
    {"obbrss.contacts", "contacts",
     "collide for all contacts, enable_contact on, and a sort by depth", CoalVolume::obbrss,
     CoalMeshQuery::all_contacts},
    {"obb.contacts", "contacts", "collide for all contacts, enable_contact on, and a sort by depth",
     CoalVolume::obb, CoalMeshQuery::all_contacts},
    {"obbrss.distance", "distance", "distance, not signed", CoalVolume::obbrss,
     CoalMeshQuery::least_distance},
    {"rss.distance", "distance", "distance, not signed", CoalVolume::rss,
     CoalMeshQuery::least_distance},
    {"obbrss.distance.warm", "distance", warm, CoalVolume::obbrss, CoalMeshQuery::warm_distance},
    {"rss.distance.warm", "distance", warm, CoalVolume::rss, CoalMeshQuery::warm_distance},
    {"obbrss.tolerance.distance", "tolerance", from_tolerance, CoalVolume::obbrss,
     CoalMeshQuery::nearer},
    {"rss.tolerance.distance", "tolerance", from_tolerance, CoalVolume::rss, CoalMeshQuery::nearer},
    {"obbrss.tolerance", "tolerance",
     "collide for one contact, enable_contact off, where the tolerance is the security margin: it "
     "ends at the first pair of triangles that is near enough",
     CoalVolume::obbrss, CoalMeshQuery::within_margin},
    {"obb.tolerance", "tolerance",
     "collide for one contact, enable_contact off, where the tolerance is the security margin: it "
     "ends at the first pair of triangles that is near enough",
     CoalVolume::obb, CoalMeshQuery::within_margin},
};

ContenderEntry meshes(const MeshRow& of) {
    constexpr const char* volumes[] = {"OBBRSS", "OBB", "RSS"};
    const bool is_nearer = of.query == CoalMeshQuery::nearer;
    const bool is_warm = of.query == CoalMeshQuery::warm_distance;
    const bool is_distance = is_nearer || is_warm || of.query == CoalMeshQuery::least_distance;
    const bool has_tolerance = is_nearer || of.query == CoalMeshQuery::within_margin;
    ContenderEntry e = row(
        of.name,
        fmt::format("BVHModel of {}, {}", volumes[static_cast<std::size_t>(of.volume)], of.how),
        fmt::format("build = one model, which stands for the mesh and for its copy (two where that "
                    "is larger); query = {}, "
                    "pose after pose, at the same model; {}; doubles, equal to the scene's floats; "
                    "one thread",
                    of.how,
                    is_distance ? "triangles by PQP's distance"
                                : "triangles by GJK; break_distance and distance_upper_bound "
                                  "0, as nobody reads the distance that their defaults are for"));
    e.answers = {{of.task, [of, has_tolerance](const Job& job) {
                      return module().meshes(job, of.volume, of.query,
                                             has_tolerance ? median_distance(*job.scene) : 0);
                  }}};
    if (of.query == CoalMeshQuery::first_contact)
        e.classes = {with_contact_class};
    if (is_warm)
        e.classes = {warm_start_class};
    return e;
}

ContenderEntry robot(const std::string& name, CoalVolume volume, LinkPairs pairs) {
    const bool is_obb = volume == CoalVolume::obb;
    const std::string how = pairs == LinkPairs::listed ? listed_pairs : managed_pairs;
    ContenderEntry e =
        row("robot." + name + (is_obb ? ".obb" : ""),
            fmt::format("BVHModel of {} for each link's mesh and its shapes for solids, pairs {}",
                        is_obb ? "OBB" : "OBBRSS", how),
            fmt::format("build = a model of each mesh, and objects; query = state after state, our "
                        "forward kinematics, objects placed, pairs {}, until two touch that must "
                        "not; collide for one contact, enable_contact off; break_distance and "
                        "distance_upper_bound 0, as nobody reads a distance; doubles; one thread",
                        how));
    e.answers = {{"robot_self", [=](const Job& job) {
                      return module().robot(RobotInScene(*job.scene), volume, pairs);
                  }}};
    return e;
}

/// Coal's trees throw for bounds that have none.
bool have_volume(const RecordedProgram& program) {
    return std::ranges::all_of(program.states, [](const RecordedProgram::State& state) {
        double volume = 1;
        for (std::size_t axis = 0; axis < 3; ++axis)
            volume *= state.bounds[3 + axis] - state.bounds[axis];
        return volume > 0;
    });
}

ReplayEntry replay(std::string name, std::string library, std::string summary,
                   std::optional<CoalManager> kind, bool with_shapes = false) {
    const auto make = [=](const RecordedProgram& program) -> std::unique_ptr<Replay> {
        if ((kind && !(have_volume(program) && program.has_near_bounds())) ||
            (with_shapes && !(program.knows_shapes() && program.has_near_poses())))
            return nullptr;
        return module().replay(program, kind, with_shapes);
    };
    return {.name = std::move(name),
            .library = std::move(library),
            .summary = std::move(summary),
            .make = make,
            .has_shapes = with_shapes};
}

} // namespace

Peer coal_peer() {
    Peer peer;
    peer.name = "coal";
    peer.title = "Coal";
    peer.summary = "Coal, FCL's successor: broad phase by dynamic AABB trees, narrow phase by GJK";
    peer.version = BOXWOOD_COAL_VERSION;
    peer.build = "the package index's library: double precision, SSE2";
    peer.contenders = managers();
    for (const MeshRow& of : mesh_rows)
        peer.contenders.push_back(meshes(of));
    for (const CoalVolume volume : {CoalVolume::obbrss, CoalVolume::obb}) {
        peer.contenders.push_back(robot("manager", volume, LinkPairs::by_manager));
        peer.contenders.push_back(robot("pairs", volume, LinkPairs::listed));
    }
    const std::string shapes = "on two TriangleP, enable_contact ";
    peer.contenders.push_back(kernel("collide", "triangle_triangle",
                                     "ComputeCollision " + shapes + "off",
                                     "GJK; Coal's default is on, FCL's off; a ComputeCollision "
                                     "kept for each pair, one call each",
                                     CoalKernel::collide));
    peer.contenders.push_back(kernel(
        "collide.contact", "triangle_triangle", "ComputeCollision " + shapes + "on, its default",
        "GJK and EPA, which finds a contact; a ComputeCollision kept for each pair, one call each",
        CoalKernel::collide_with_contact));
    peer.contenders.push_back(kernel("tri_distance", "triangle_distance",
                                     "TriangleDistance::sqrTriDistance, after PQP",
                                     "one pair per call; the root is taken", CoalKernel::distance));
    append_shapes(peer.contenders);
    const std::string tree = "DynamicAABBTreeCollisionManager",
                      array = "DynamicAABBTreeArrayCollisionManager",
                      median = ", split at the median, its default",
                      morton = ", tree_init_level 2: in Morton order";
    peer.replays = {
        replay("boxwood.coal_manager", "boxwood",
               "boxwood::CoalBroadPhase, in place of Coal's managers", std::nullopt),
        replay("coal.dynamic_aabb_tree", "coal", tree + median, CoalManager::tree_median),
        replay("coal.dynamic_aabb_tree.morton", "coal", tree + morton, CoalManager::tree),
        replay("coal.dynamic_aabb_tree_array", "coal", array + median,
               CoalManager::tree_array_median),
        replay("coal.dynamic_aabb_tree_array.morton", "coal", array + morton,
               CoalManager::tree_array),
        replay("coal.ssap", "coal", "SSaPCollisionManager: objects sorted by their minima",
               CoalManager::ssap),
        replay("boxwood.coal_manager, Coal's shapes", "boxwood",
               "boxwood::CoalBroadPhase with coal::collide and coal::distance", std::nullopt, true),
        replay("coal.dynamic_aabb_tree, Coal's shapes", "coal",
               tree + " with coal::collide and coal::distance", CoalManager::tree_median, true),
        replay("coal.dynamic_aabb_tree_array, Coal's shapes", "coal",
               array + " with coal::collide and coal::distance", CoalManager::tree_array_median,
               true)};
    return peer;
}

} // namespace boxwood::bench
