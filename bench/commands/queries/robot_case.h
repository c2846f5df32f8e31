#pragma once

#include "bench/commands/queries/user_mesh.h"
#include "kernels/primitives/triangle.h"
#include "scenes/robots/srdf.h"
#include "trees/world/allowed_pairs.h"
#include "trees/world/robot.h"
#include "trees/world/robot_collision.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace boxwood::bench {

/// The files that describe a robot.
struct RobotFiles {
    std::string urdf;
    std::optional<std::string> srdf; ///< without it the allowed pairs are proposed
    std::vector<std::filesystem::path> package_paths;
    bool are_solid = false; ///< closed meshes of links
    BadTriangles bad_triangles = BadTriangles::keep;
};
/// The argument URDF and the options --srdf, --package-path, --solid and --bad-triangles.
void add_robot_options(CLI::App& app, RobotFiles& files);

/// A robot, and what is known of its collisions.
struct RobotCase {
    Robot robot;
    std::vector<TriangleMesh> meshes;
    LinkBoxes boxes;
    AllowedPairs allowed; ///< those of the SRDF file
    std::vector<Srdf::State> named_states;
};
/// Says so if nothing of it can collide, and which meshes are to be solid and are not closed.
std::unique_ptr<RobotCase> read_robot(const RobotFiles& files);

/// What answers about the geometry of the links of a robot with these meshes.
using MakeLinkNarrowPhase = std::function<std::unique_ptr<LinkNarrowPhase>(
    const Robot& robot, std::span<const TriangleMesh> meshes, bool are_solid)>;

/// For handlers: what files and names have wrong is thrown again as BadInput.
[[noreturn]] void rethrow_as_bad_input();

} // namespace boxwood::bench
