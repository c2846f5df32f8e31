#pragma once

#include "bench/peers/answering.h"
#include "bench/peers/managers.h"
#include "bench/peers/robot_queries.h"
#include "bench/replay/replay.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

namespace coal {
class BroadPhaseCollisionManager;
}

namespace boxwood::bench {

/// Coal's managers of broad phases; trees in Morton order, or split at the median.
enum class CoalManager : std::uint8_t {
    tree,
    tree_median,
    tree_array,
    tree_array_median,
    sap,
    ssap,
    hash,
    interval_tree
};

/// Coal's answers about two triangles.
enum class CoalKernel : std::uint8_t { collide, collide_with_contact, distance };

/// What is asked of two convex shapes, and which of Coal's forms of GJK answers.
enum class CoalShapeQuery : std::uint8_t { collide, distance, signed_distance };
enum class CoalGjk : std::uint8_t { plain, polyak, nesterov };
/// In shapes.cpp, within the module.
std::unique_ptr<Contender> make_coal_shapes(const Job& job, CoalShapeQuery query, CoalGjk gjk);

/// What makes Coal's manager of a kind, or ours in its place.
using MakeCoalManager = std::function<std::unique_ptr<coal::BroadPhaseCollisionManager>()>;
/// With Coal's shapes. In shape_replay.cpp, within the module.
std::unique_ptr<Replay> make_coal_shape_replay(const RecordedProgram& program,
                                               MakeCoalManager make);

/// Coal's models of a mesh, by their volume, and what they answer of it and its copy.
enum class CoalVolume : std::uint8_t { obbrss, obb, rss };
enum class CoalMeshQuery : std::uint8_t {
    first_touch,
    first_contact, ///< with its point, normal and depth
    all_touches,
    all_contacts,
    least_distance,
    warm_distance, ///< each result starts at the triangles of the one before
    nearer,        ///< each starts at the tolerance
    within_margin  ///< the tolerance is a security margin
};
/// tolerance: of the last two, scene units. In meshes.cpp, within the module.
std::unique_ptr<Contender> make_coal_meshes(const Job& job, CoalVolume volume, CoalMeshQuery query,
                                            double tolerance);

/// Self-collision of a robot. In robots.cpp, within the module.
std::unique_ptr<Contender> make_coal_robot(RobotInScene robot, CoalVolume volume, LinkPairs pairs);

/// The library behind a door: a module that is opened when a contender is made. In one process with
/// FCL's package two octomaps would meet under the same names, and the program end in a double
/// free.
struct CoalModule {
    std::unique_ptr<Contender> (*manager)(const Job&, Sides, CoalManager, Reported);
    std::unique_ptr<Contender> (*kernel)(const Job&, CoalKernel);
    std::unique_ptr<Contender> (*shapes)(const Job&, CoalShapeQuery, CoalGjk);
    std::unique_ptr<Contender> (*meshes)(const Job&, CoalVolume, CoalMeshQuery, double);
    std::unique_ptr<Contender> (*robot)(RobotInScene, CoalVolume, LinkPairs);
    /// Without a manager of Coal's, ours in its place; by bounds alone, or with Coal's shapes.
    std::unique_ptr<Replay> (*replay)(const RecordedProgram&, std::optional<CoalManager>,
                                      bool with_shapes);
};

/// The module has `extern "C" const CoalModule boxwood_coal`.
inline constexpr const char* coal_module_symbol = "boxwood_coal";

} // namespace boxwood::bench
