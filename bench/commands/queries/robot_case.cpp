#include "bench/commands/queries/robot_case.h"

#include "bench/io/bad_input.h"
#include "bench/io/say.h"
#include "scenes/robots/urdf.h"
#include "trees/queries/sides.h"
#include "trees/world/propose_pairs.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <stdexcept>

namespace boxwood::bench {

void add_robot_options(CLI::App& app, RobotFiles& files) {
    app.add_option("URDF", files.urdf, "the robot")->required();
    app.add_option("--srdf", files.srdf, "an SRDF file: pairs that may collide, states");
    app.add_option("--package-path", files.package_paths,
                   "a folder that holds the packages of package:// meshes; may be repeated");
    app.add_flag("--solid", files.are_solid,
                 "closed meshes of links are solids: what lies inside one touches it");
    add_bad_triangles_option(app, files.bad_triangles);
}

std::unique_ptr<RobotCase> read_robot(const RobotFiles& files) {
    UrdfRobot read =
        read_urdf(files.urdf, files.package_paths, [&](const std::filesystem::path& file) {
            TriangleMesh mesh =
                read_user_mesh(file.string(), files.bad_triangles, files.are_solid).mesh;
            const std::size_t open = files.are_solid ? open_edges(mesh) : 0;
            if (open > 0)
                say(fmt::format("boxwood: {}: {} edges belong to an odd number of triangles: it is "
                                "no solid, and its surface alone counts\n",
                                file.string(), open));
            return mesh;
        });
    std::vector<Aabb<float>> mesh_boxes(read.meshes.size());
    for (std::size_t i = 0; i < read.meshes.size(); ++i)
        for (std::size_t t = 0; t < read.meshes[i].triangles.size(); ++t)
            mesh_boxes[i].extend(read.meshes[i].triangle(t).bounds());
    Robot robot(std::move(read.description));
    LinkBoxes boxes(robot, mesh_boxes);
    AllowedPairs allowed = no_allowed_pairs(robot);
    std::vector<Srdf::State> named_states;
    if (files.srdf) {
        Srdf srdf = read_srdf(*files.srdf, robot.description());
        for (AllowedPair& pair : srdf.allowed)
            allowed.allow(pair.a, pair.b, pair.reason, std::move(pair.note));
        named_states = std::move(srdf.states);
    }
    if (boxes.links().empty())
        say(fmt::format("boxwood: no link of {} has a <collision> element, and <visual> ones are "
                        "not read: nothing can collide\n",
                        files.urdf));
    return std::make_unique<RobotCase>(RobotCase{std::move(robot), std::move(read.meshes),
                                                 std::move(boxes), std::move(allowed),
                                                 std::move(named_states)});
}

void rethrow_as_bad_input() {
    try {
        throw;
    } catch (const BadInput&) {
        throw;
    } catch (const Interrupted&) {
        throw;
    } catch (const std::runtime_error& error) { // of the files
        throw BadInput(error.what());
    } catch (const std::invalid_argument& error) { // of names
        throw BadInput(error.what());
    }
}

} // namespace boxwood::bench
