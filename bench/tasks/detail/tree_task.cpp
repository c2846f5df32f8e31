#include "bench/tasks/detail/tree_task.h"

#include "bench/plan/scenes.h"
#include "kernels/suggest.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {

std::string name_with_settings(std::string text, const Settings& settings) {
    std::ranges::replace(text, '+', '_');
    for (const auto& [name, value] : settings) {
        text += fmt::format("_{}", name);
        for (const char c : to_text(value))
            if (c != '+')
                text += c == '.' ? '_' : c == '-' ? 'm' : c;
    }
    return text;
}

std::string settings_json(const Settings& settings) {
    std::string all;
    for (const auto& [name, value] : settings)
        all += fmt::format("{}\"{}\": {}", all.empty() ? "" : ", ", name,
                           std::holds_alternative<std::string>(value)
                               ? '"' + std::get<std::string>(value) + '"'
                               : to_text(value));
    return "{" + all + "}";
}

const BuilderEntry& builder_of(const Choice& choice) {
    return entry_named(std::string_view(choice.builder).substr(0, choice.builder.find('+')),
                       builders(), "builder");
}

ContenderEntry entry_of_ours(const BuilderEntry& builder, const Choice& choice) {
    ContenderEntry entry;
    entry.library = "boxwood";
    entry.is_peer = false;
    entry.builder = name_with_settings(choice.builder, choice.settings);
    entry.place = static_cast<std::size_t>(&builder - builders().data());
    entry.is_plain = entry.builder == builder.name && !choice.by_front_door;
    entry.is_reference = builder.is_reference && entry.is_plain;
    entry.params_json = settings_json(choice.settings);
    return entry;
}

void add_cells(const BlockReader& block, const SceneSpec& scene,
               const std::vector<ContenderEntry>& ours, const std::vector<ContenderEntry>& peers,
               AddCell add) {
    for (const Place& place : block.places())
        for (const ContenderEntry& entry : ours)
            add(scene, entry, place.executor, place.threads);
    const auto add_peers = [&](bool on_device, const std::vector<Place>& places) {
        for (const Place& place : places)
            for (const ContenderEntry& entry : peers)
                if ((entry.runs_on == RunsOn::device) == on_device)
                    add(scene, entry, place.executor, place.threads);
    };
    add_peers(false, block.usual_places());
    add_peers(true, block.device_places());
}

std::vector<std::string_view> TreeTask::keys() const {
    return {"scene", "n", "overlaps", "builders", "layouts", "executors", "threads", "peers"};
}

void TreeTask::expand(const BlockReader& block, AddCell add) const {
    std::vector<SceneSpec> scenes;
    for (const SceneSpec& scene : still_scenes(block, mesh_is_for()))
        for (const SceneSpec& spec : with_queries(block, scene))
            scenes.push_back(spec);
    std::vector<ContenderEntry> ours;
    const bool by_front_door = !block.names("front_door", {"bvh"}).empty();
    const std::vector<std::string> layout_names =
        block.names("layouts", names_of(layouts()), {"wide8"});
    for (const BuilderChoice& builder : block.builders())
        for (const std::string& layout : layout_names)
            for (const Choice& choice :
                 variants(block, {builder.name, builder.settings, layout, "", ""})) {
                ours.push_back(contender(choice));
                if (by_front_door && way(choice).make_by_front_door) {
                    Choice by_door = choice;
                    by_door.by_front_door = true;
                    ours.push_back(contender(by_door));
                }
            }
    const std::vector<ContenderEntry> peers = block.peers(name());
    block.places(); // refuses bad ones even if nothing runs there
    if (ours.empty() && !block.has("peers"))
        block.fail("[[cells]] needs builders, peers, or both");
    for (const SceneSpec& scene : scenes)
        add_cells(block, scene, ours, peers, add);
}

ContenderEntry TreeTask::contender(const Choice& choice) const {
    const BuilderEntry& builder = builder_of(choice);
    const LayoutEntry& layout = entry_named(choice.layout, layouts(), "layout");
    Way way = this->way(choice);

    ContenderEntry entry = entry_of_ours(builder, choice);
    entry.precision = layout.precision;
    entry.layout = choice.layout;
    entry.traversal = way.traversal;
    entry.kernel = way.kernel;
    entry.promise = way.promise;
    entry.classes = std::move(way.classes);
    entry.name = fmt::format("{}.{}.{}", entry.builder, entry.layout, entry.traversal);
    if (!entry.kernel.empty())
        entry.name += "." + entry.kernel;
    if (choice.by_front_door) {
        entry.name = "bvh." + entry.name;
        way.make = std::move(way.make_by_front_door);
        way.make_on_device = way.make_by_graph = nullptr;
        way.why_not_on_device = "trees/bvh.h is for the host";
    }
    entry.summary = fmt::format("{}; {}", builder.summary, layout.summary);
    entry.notes =
        "build: from boxes, or from triangles where rays or surface points are wanted, to tree to "
        "layout; answers in the same order for any number of "
        "threads";
    if (choice.by_front_door)
        entry.notes += "; by the front door (trees/bvh.h) around the same parts";
    entry.cannot =
        [this, &layout, query = way.query, cannot = std::move(way.cannot),
         why_not = std::move(way.why_not_on_device)](const Job& job) -> std::optional<std::string> {
        if (query && !layout.answers(*query))
            return fmt::format("the layout {} does not answer {}", layout.name, to_string(*query));
        if (auto why = cannot ? cannot(*job.scene) : std::nullopt)
            return why;
        if (!is_device(job.executor))
            return std::nullopt;
        return why_not.empty() ? missing_on_device(*job.scene)
                               : "has no form for a device: " + why_not;
    };
    entry.answers = {
        {std::string(name()),
         [build = make_builder(choice.builder, choice.settings), &layout,
          make = std::move(way.make)](const Job& job) { return make(job, build, layout); },
         std::move(way.make_on_device), std::move(way.make_by_graph)}};
    return entry;
}

std::optional<std::string> TreeTask::missing(const Scene& scene) const {
    if (!mesh_is_for().empty() && scene.mesh.triangles.empty())
        return "the scene has no triangles";
    return std::nullopt;
}

} // namespace boxwood::bench
