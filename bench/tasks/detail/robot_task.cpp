#include "bench/tasks/detail/robot_task.h"

#include "bench/plan/block_reader.h"
#include "bench/tasks/detail/tree_task.h"
#include "scenes/robots/robot_scene.h"

#include <fmt/format.h>

#include <stdexcept>

namespace boxwood::bench {

void RobotTask::expand(const BlockReader& block, AddCell add) const {
    block.names("scene", {robot_scene});
    const std::vector<ContenderEntry> peers = block.peers(name());
    const std::vector<std::string> kinds =
        block.names("states", {random_states, states_along}, {std::string(random_states)});
    for (const OwnScene& own : block.inputs().own) {
        if (own.generator != robot_scene)
            continue;
        SceneSpec spec;
        spec.generator = own.generator;
        spec.file = own.file;
        spec.n = own.items;
        spec.seed = block.inputs().seed;
        spec.n_poses = block.integer("n_states", 1, 1'000'000).value_or(256);
        for (const std::string& kind : kinds) {
            spec.poses = kind == random_states ? "" : kind;
            add_cells(block, spec, {contender({})}, peers, add);
        }
    }
}

ContenderEntry RobotTask::contender(const Choice& choice) const {
    if (choice.builder != Choice{}.builder || !choice.settings.empty())
        throw std::invalid_argument(
            fmt::format("{}: the trees of a robot's links are built by {}, not by {}", name(),
                        Choice{}.builder, choice.builder));
    ContenderEntry entry = entry_of_ours(builder_of(choice), choice);
    entry.precision = "f64";
    entry.layout = "obb";
    entry.traversal = name();
    entry.promise = Promise::certified;
    entry.name = fmt::format("{}.{}.{}", entry.builder, entry.layout, entry.traversal);
    entry.summary = "boxes of the links, then their meshes' trees and solids";
    entry.notes = fmt::format("build: a tree of each mesh; query: state after state, forward "
                              "kinematics, {}; exact for two meshes, certified for solids",
                              query_notes());
    entry.runs_on = RunsOn::one_thread;
    entry.answers = {{std::string(name()), make()}};
    return entry;
}

std::optional<std::string> RobotTask::missing(const Scene& scene) const {
    if (!scene.robot)
        return "the scene has no robot; --robot FILE.urdf brings one";
    return std::nullopt;
}

std::uint64_t RobotTask::n_queries(const Scene& scene) const {
    return scene.robot ? scene.robot->states.size() : 0;
}

} // namespace boxwood::bench
