#include "bench/tasks/detail/mesh_pair_task.h"

#include "bench/plan/block_reader.h"
#include "bench/plan/scenes.h"
#include "bench/tasks/detail/tree_task.h"
#include "kernels/suggest.h"
#include "scenes/sampling/poses.h"

#include <fmt/format.h>

#include <string>

namespace boxwood::bench {
std::vector<std::string_view> MeshPairTask::keys() const {
    return {"scene", "n", "poses", "n_poses", "builders", "volumes", "threads", "peers"};
}

std::vector<SceneSpec> MeshPairTask::posed_scenes(const BlockReader& block) const {
    std::vector<SceneSpec> scenes;
    const std::size_t n_poses = block.integer("n_poses", 1, 100'000).value_or(16);
    for (const SceneSpec& scene : still_scenes(block, "place copies of"))
        for (const std::string& kind :
             block.names("poses", names_of(pose_kinds()), usual_poses())) {
            scenes.push_back(scene);
            scenes.back().poses = kind;
            scenes.back().n_poses = n_poses;
        }
    return scenes;
}

void MeshPairTask::expand(const BlockReader& block, AddCell add) const {
    std::vector<ContenderEntry> ours;
    const std::vector<std::string> wanted = block.names("volumes", names_of(mesh_volumes()),
                                                        {std::string(mesh_volumes().front().name)});
    const std::vector<Choice> queries = variants(block);
    for (const BuilderChoice& builder : block.builders())
        for (const std::string& volume : wanted)
            for (Choice choice : queries) {
                choice.builder = builder.name;
                choice.settings = builder.settings;
                choice.layout = volume;
                ours.push_back(contender(choice));
            }
    const std::vector<ContenderEntry> peers = block.peers(name());
    if (ours.empty() && !block.has("peers"))
        block.fail("[[cells]] needs builders, peers, or both");
    for (const SceneSpec& scene : posed_scenes(block))
        add_cells(block, scene, ours, peers, add);
}

ContenderEntry MeshPairTask::contender(const Choice& choice) const {
    const BuilderEntry& builder = builder_of(choice);
    const MeshVolumeEntry& volume = entry_named(choice.layout, mesh_volumes(), "volume");
    ContenderEntry entry = entry_of_ours(builder, choice);
    entry.precision = "f64";
    entry.layout = volume.name;
    entry.traversal = name();
    entry.promise = promise();
    entry.name = fmt::format("{}.{}.{}", entry.builder, entry.layout, entry.traversal);
    entry.summary = fmt::format("{}; {}", builder.summary, volume.summary);
    entry.notes = fmt::format("build: one tree, which stands for the mesh and for its copy (two "
                              "where that is larger); query: "
                              "{}; the copy's corners are moved in doubles, boxes are bounded in "
                              "floats, those of the roots in doubles",
                              query_notes());
    add_variant(choice, entry);
    entry.runs_on = runs_on();
    entry.answers = {{std::string(name()),
                      [build = make_builder(choice.builder, choice.settings), kind = volume.volume,
                       make = make(choice)](const Job& job) { return make(job, build, kind); }}};
    return entry;
}

std::optional<std::string> MeshPairTask::missing(const Scene& scene) const {
    if (scene.poses.empty())
        return "the scene has no poses of a copy";
    return std::nullopt;
}

} // namespace boxwood::bench
