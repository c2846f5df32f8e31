#include "scenes/moving/scene_file.h"

#include "kernels/suggest.h"
#include "scenes/effects/read_effect.h"
#include "scenes/moving/toml_reader.h"
#include "scenes/scene.h"
#include "scenes/text/read_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace boxwood {
namespace {

constexpr std::int64_t max_bodies = 100'000'000;
constexpr std::int64_t max_queries = 10'000'000;

/// "pairs", or {name = "regions", n = 100, kind = "flying"}.
SceneQuery read_query(const TomlReader& reader, const toml::node& node) {
    const toml::table* table = node.as_table();
    const toml::node* name = table ? table->get("name") : &node;
    if (!name || (!table && !node.is_string()))
        reader.fail(node.source(), "a query is a name, or {name = \"NAME\", n = NUMBER, ...}");
    const std::string found = reader.name(*name, "queries", names_of(scene_queries()));
    const SceneQueryEntry& entry =
        *std::ranges::find(scene_queries(), found, &SceneQueryEntry::name);
    SceneQuery query = entry.defaults;
    query.name = found;
    if (!table)
        return query;
    TomlReader::Names known = entry.keys;
    known.push_back("name");
    reader.require_known_keys(*table, "the query " + found, known);
    if (const toml::node* kind = table->get("kind"))
        query.kind = reader.name(*kind, "kind", names_of(query_kinds()));
    if (const toml::node* n = table->get("n"))
        query.n = reader.whole(*n, "n", 1, max_queries);
    if (const toml::node* k = table->get("k"))
        query.k = reader.whole(*k, "k", 1, 1000);
    if (const toml::node* size = table->get("size"))
        query.size = reader.number(*size, "size", 0, 1e6);
    return query;
}

void read_queries(const TomlReader& reader, const toml::table& root,
                  std::vector<SceneQuery>& queries) {
    reader.list(root, "queries", queries, [&](const toml::node& node) {
        SceneQuery query = read_query(reader, node);
        if (std::ranges::find(queries, query.name, &SceneQuery::name) != queries.end())
            reader.fail(node.source(), fmt::format("'{}' is named twice", query.name));
        return query;
    });
    if (queries.empty())
        reader.fail(root.get("queries")->source(),
                    "queries must name something, such as \"pairs\"");
}

bool read_flag(const TomlReader& reader, const toml::table& table, std::string_view key) {
    const toml::node* node = table.get(key);
    if (!node)
        return false;
    const auto value = node->value<bool>();
    if (!value || !node->is_boolean())
        reader.fail(node->source(), fmt::format("{} must be true or false", key));
    return *value;
}

TomlReader::Names generators(bool meshes_alone) {
    TomlReader::Names names;
    for (const SceneEntry& entry : scene_generators())
        if (!entry.reads_file && (entry.has_mesh || !meshes_alone))
            names.push_back(entry.name);
    return names;
}

BodyGroup read_group(const TomlReader& reader, const toml::table& table) {
    reader.require_known_keys(table, "[[bodies]]",
                              {"generator", "n", "share", "overlaps", "shape", "triangles", "scale",
                               "at", "margin", "neighbours_ignored", "group_ignored", "effects"});
    BodyGroup group;
    const toml::node* generator = table.get("generator");
    if (!generator)
        reader.fail(table.source(),
                    "[[bodies]] needs a generator, such as generator = \"uniform\"");
    group.generator = reader.name(*generator, "generator", generators(false));
    if (const toml::node* n = table.get("n"))
        group.n = reader.whole(*n, "n", 1, max_bodies);
    if (const toml::node* share = table.get("share")) {
        if (group.n != 0)
            reader.fail(share->source(),
                        "[[bodies]] takes n or a share of the scene's n, not both");
        group.share = reader.number(*share, "share", 0, 1);
    }
    if (const toml::node* overlaps = table.get("overlaps"))
        group.overlaps = reader.number(*overlaps, "overlaps", 0, 1e6);
    const toml::node* triangles = table.get("triangles");
    if (const toml::node* shape = table.get("shape")) {
        group.shape = reader.name(*shape, "shape", generators(true));
        if (!triangles)
            reader.fail(shape->source(), "a shape needs triangles, such as triangles = 100");
        group.triangles = reader.whole(*triangles, "triangles", 1, max_bodies);
    } else if (triangles) {
        reader.fail(triangles->source(),
                    "triangles is for a shape, such as shape = \"sphere_mesh\"");
    }
    if (const toml::node* scale = table.get("scale"))
        group.scale = reader.number(*scale, "scale", 1e-6, 1e6);
    std::vector<double> at;
    reader.list(table, "at", at,
                [&](const toml::node& node) { return reader.number(node, "at", -1e30, 1e30); });
    if (!at.empty() && at.size() != 3)
        reader.fail(table.get("at")->source(), "at must be three numbers, such as at = [0, 0, 1]");
    if (!at.empty())
        group.at = {at[0], at[1], at[2]};
    if (const toml::node* margin = table.get("margin"))
        group.margin = reader.number(*margin, "margin", 0, 1e30);
    group.neighbours_ignored = read_flag(reader, table, "neighbours_ignored");
    group.group_ignored = read_flag(reader, table, "group_ignored");
    reader.list(table, "effects", group.effects,
                [&](const toml::node& node) { return read_effect(reader, node); });
    return group;
}

} // namespace

SceneFile parse_scene_file(std::string_view text, const std::string& file) {
    const TomlReader reader(file);
    const toml::table root = reader.parse(text);
    reader.require_known_keys(root, "a scene file",
                              {"summary", "source", "licence", "n", "seed", "frames",
                               "frames_per_second", "view", "queries", "bodies"});
    SceneFile scene;
    scene.name = std::filesystem::path(file).stem().string();
    if (const toml::node* summary = root.get("summary"))
        scene.summary = reader.text(*summary, "summary");
    if (const toml::node* source = root.get("source"))
        scene.source = reader.text(*source, "source");
    if (const toml::node* licence = root.get("licence"))
        scene.licence = reader.text(*licence, "licence");
    if (const toml::node* n = root.get("n"))
        scene.n = reader.whole(*n, "n", 1, max_bodies);
    if (const toml::node* seed = root.get("seed"))
        scene.seed = reader.whole(*seed, "seed", 0, std::numeric_limits<std::int64_t>::max());
    if (const toml::node* frames = root.get("frames"))
        scene.frames = reader.whole(*frames, "frames", 1, 100'000'000);
    if (const toml::node* fps = root.get("frames_per_second"))
        scene.frames_per_second = reader.number(*fps, "frames_per_second", 1e-3, 1e6);
    if (const toml::node* view = root.get("view"))
        scene.view = reader.name(*view, "view", {"xy", "xz", "yz"});
    read_queries(reader, root, scene.queries);
    const toml::node* bodies = root.get("bodies");
    const toml::array* groups = bodies ? bodies->as_array() : nullptr;
    if (!groups || groups->empty())
        throw std::invalid_argument(file + ": no [[bodies]] block: there is nothing in the scene");
    for (const toml::node& node : *groups) {
        if (!node.is_table())
            reader.fail(node.source(), "bodies must be [[bodies]] blocks");
        scene.groups.push_back(read_group(reader, *node.as_table()));
    }
    return scene;
}

const SceneQuery* query_named(const SceneFile& file, std::string_view name) {
    const auto found = std::ranges::find(file.queries, name, &SceneQuery::name);
    return found == file.queries.end() ? nullptr : &*found;
}

std::span<const BuiltInScene> built_in_scenes() {
    static constexpr BuiltInScene scenes[] = {
#include "built_in_scenes.inc"
    };
    return scenes;
}

SceneFile load_scene(const std::string& name_or_path) {
    for (const BuiltInScene& scene : built_in_scenes())
        if (scene.name == name_or_path)
            return parse_scene_file(scene.text, name_or_path + ".toml");
    if (!name_or_path.ends_with(".toml"))
        throw std::invalid_argument(
            unknown_name("scene", name_or_path, names_of(built_in_scenes())) +
            "; a scene file of your own ends in .toml");
    return parse_scene_file(read_file(name_or_path), name_or_path);
}

} // namespace boxwood
