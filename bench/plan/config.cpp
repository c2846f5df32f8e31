#include "bench/plan/config.h"

#include "bench/io/bad_input.h"
#include "bench/plan/config_reader.h"
#include "bench/plan/families.h"
#include "bench/tasks/rays.h"
#include "bench/tasks/kernels/kernels.h"
#include "kernels/registry.h"
#include "scenes/effects/effect.h"
#include "scenes/sampling/queries.h"
#include "scenes/scene.h"
#include "trees/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace boxwood::bench {
namespace {

using Reader = ConfigReader;

/// "all", every peer library (found or not), and every contender of those that were found.
Words peer_words() {
    Words words{"all"};
    for (const Peer& peer : peers()) {
        words.push_back(peer.name);
        for (const ContenderEntry& contender : peer.contenders)
            if (contender.name != peer.name)
                words.push_back(contender.name);
    }
    for (const std::string_view name : absent_peers())
        words.emplace_back(name);
    return words;
}

/// What a `kernels` key may say for an ask; empty if it takes none.
Words kernel_words(Ask ask) {
    return is_kernel_ask(ask)           ? names_of(rungs(ask))
           : is_ray_ask(ask)            ? names_of(ray_kernels())
           : ask == Ask::triangle_pairs ? names_of(triangle_kernels())
                                        : Words{};
}

/// Keys that only kernel asks take, and those that only the others do.
constexpr std::array kernel_keys{"scale"};
constexpr std::array tree_keys{"effects", "frames",    "updates",  "overlaps", "rays",
                               "n_rays",  "ray_order", "builders", "layouts",  "executors",
                               "threads", "stages",    "without"};
constexpr std::array point_keys{"n_points", "regions"};

/// The asks of a block are all kernel asks or none is.
bool asks_kernels(const Reader& reader, const toml::table& table, const Block& block) {
    const bool some = std::ranges::any_of(block.tasks, is_kernel_ask);
    if (some && !std::ranges::all_of(block.tasks, is_kernel_ask))
        reader.fail(table.source(), "asks of kernels and of trees need [[cells]] blocks of their "
                                    "own");
    const auto refuse = [&](const auto& keys, const char* whose) {
        for (const char* key : keys)
            if (const toml::node* node = table.get(key))
                reader.fail(node->source(), fmt::format("{} is for the asks of {}", key, whose));
    };
    if (some) {
        refuse(tree_keys, "trees");
        refuse(point_keys, "trees");
    } else {
        refuse(kernel_keys, "kernels");
    }
    if (const toml::node* k = table.get("k");
        k && !some && std::ranges::find(block.tasks, Ask::nearest) == block.tasks.end())
        reader.fail(k->source(), "k is for the asks of kernels and for nearest");
    return some;
}

void read_kernels(const Reader& reader, const toml::table& table, Block& block) {
    const toml::node* node = table.get("kernels");
    if (!node)
        return;
    Words known{"all"};
    for (const Ask ask : block.tasks)
        for (const std::string_view word : kernel_words(ask))
            if (std::ranges::find(known, word) == known.end())
                known.push_back(word);
    if (known.size() == 1)
        reader.fail(node->source(),
                    fmt::format("the ask {} takes no kernels", to_string(block.tasks.front())));
    reader.words(table, "kernels", block.kernels.emplace(), known);
    for (const Ask ask : block.tasks)
        for (const std::string& word : *block.kernels) {
            const Words words = kernel_words(ask);
            if (word != "all" && std::ranges::find(words, word) == words.end())
                reader.fail(node->source(), fmt::format("kernels: the ask {} has no kernel {}; "
                                                        "give it a [[cells]] block of its own",
                                                        to_string(ask), word));
        }
}

/// The keys of a block of kernel asks.
void read_families(const Reader& reader, const toml::table& table, Block& block) {
    reader.words(table, "scene", block.scenes, family_words());
    const auto read_int = [&](std::string_view key) {
        return [&reader, key](const toml::node& node) {
            return static_cast<int>(
                static_cast<std::int64_t>(reader.whole(node, key, -100'000, 100'000)));
        };
    };
    reader.list(table, "k", block.k, read_int("k"));
    reader.list(table, "scale", block.scales, read_int("scale"));
    for (const std::string& scene : block.scenes)
        for (const Ask ask : block.tasks) {
            if (is_group(scene) && !block.k.empty())
                reader.fail(table.get("k")->source(),
                            fmt::format("k means something else for each family: name the "
                                        "families instead of \"{}\"",
                                        scene));
            if (families_of(scene, ask).empty())
                reader.fail(
                    table.get("scene")->source(),
                    is_group(scene) || !find_hard_case_family(scene)->reads_file
                        ? fmt::format("\"{}\" has no cases for the ask {}", scene, to_string(ask))
                        : fmt::format("the family \"{}\" reads files: only `boxwood check "
                                      "--ccd DIR` takes it",
                                      scene));
        }
}

/// The keys of a block for the asks of points and regions.
void read_queries(const Reader& reader, const toml::table& table, Block& block) {
    const toml::node* n_points = table.get("n_points");
    if (n_points && std::ranges::none_of(block.tasks, is_point_ask))
        reader.fail(n_points->source(), "n_points is for the asks of points and regions");
    if (n_points)
        block.n_points = reader.whole(*n_points, "n_points", 1, 1'000'000'000);
    if (const toml::node* regions = table.get("regions");
        regions && std::ranges::find(block.tasks, Ask::regions) == block.tasks.end())
        reader.fail(regions->source(), "regions is for the ask regions");
    reader.words(table, "regions", block.regions, names_of(region_kinds()));
    reader.list(table, "k", block.k, [&](const toml::node& node) {
        return static_cast<int>(reader.whole(node, "k", 1, 1000));
    });
}

bool has(const std::vector<Ask>& asks, Ask ask) {
    return std::ranges::find(asks, ask) != asks.end();
}

/// What only some asks take is not there for the others.
template <std::size_t N>
void only_for(const Reader& reader, const toml::table& table, bool asked, const char* whose,
              const std::array<const char*, N>& keys) {
    for (const char* key : keys)
        if (const toml::node* node = table.get(key); node && !asked)
            reader.fail(node->source(), fmt::format("{} is for {}", key, whose));
}

/// The keys of a block of asks of moving scenes.
void read_moving(const Reader& reader, const toml::table& table, Block& block) {
    if (!std::ranges::all_of(block.tasks, is_moving_ask))
        reader.fail(table.source(), "moving_pairs and scene_queries need [[cells]] blocks of their "
                                    "own");
    reader.list(table, "scene", block.scenes,
                [&](const toml::node& node) { return reader.moving_scene(node); });
    reader.list(table, "effects", block.effects,
                [&](const toml::node& node) { return reader.effects(node); });
    if (const toml::node* frames = table.get("frames"))
        block.n_frames = reader.whole(*frames, "frames", 1, 100'000'000);
    if (!table.get("n"))
        block.n.clear();

    const Words generators = names_of(scene_generators());
    const auto is_generator = [&](const std::string& scene) {
        return std::ranges::find(generators, scene) != generators.end();
    };
    for (const std::string& scene : block.scenes) {
        if (is_generator(scene) && block.effects.empty())
            reader.fail(table.source(),
                        fmt::format("{} stands still: it needs effects, such as effects = "
                                    "\"drift\" (`boxwood list effects`), or name a moving scene",
                                    scene));
        if (!is_generator(scene))
            for (const char* key : {"effects", "overlaps"})
                if (const toml::node* node = table.get(key))
                    reader.fail(node->source(),
                                fmt::format("{} is for generators; the moving scene {} has its "
                                            "own",
                                            key, scene));
    }
    const bool asks_scene = has(block.tasks, Ask::scene_queries);
    only_for(reader, table, has(block.tasks, Ask::moving_pairs), "the ask moving_pairs",
             std::array{"updates", "peers"});
    only_for(reader, table, asks_scene, "the ask scene_queries", std::array{"stages", "without"});
    only_for(reader, table, false, "the asks of trees that stand still",
             std::array{"builders", "layouts", "rays", "n_rays"});
    reader.words(table, "stages", block.stages, {"required", "all_stages"});
    Words effect_words = names_of(effects());
    effect_words.insert(effect_words.begin(), "each");
    reader.words(table, "without", block.without, effect_words);
    if (asks_scene && block.stages.empty() && block.without.empty())
        reader.fail(table.source(), "scene_queries needs stages: required, everything, or both");
    if (has(block.tasks, Ask::moving_pairs) && block.updates.empty() && block.peers.empty())
        reader.fail(table.source(), "[[cells]] needs updates, peers, or both");
}

/// The keys of a block of asks of trees.
void read_trees(const Reader& reader, const toml::table& table, Block& block) {
    const bool moves = std::ranges::any_of(block.tasks, is_moving_ask);
    if (!moves)
        reader.words(table, "scene", block.scenes, names_of(scene_generators()));
    const bool has_mesh = std::ranges::find(block.scenes, "mesh") != block.scenes.end();
    if (has_mesh && block.scenes.size() > 1)
        reader.fail(table.source(), "the scene \"mesh\" needs a [[cells]] block of its own");
    if (const toml::node* n = table.get("n"); n && has_mesh)
        reader.fail(n->source(), "the scene \"mesh\" takes no n: the size is that of its file");
    reader.list(table, "overlaps", block.overlaps,
                [&](const toml::node& node) { return reader.number(node, "overlaps", 0, 1e6); });
    reader.words(table, "rays", block.rays, names_of(ray_kinds()));
    if (const toml::node* n_rays = table.get("n_rays"))
        block.n_rays = reader.whole(*n_rays, "n_rays", 1, 1'000'000'000);
    if (const toml::node* order = table.get("ray_order");
        order && std::ranges::none_of(block.tasks, has_ray_order))
        reader.fail(order->source(), "ray_order is for the asks rays_closest and rays_any");
    reader.words(table, "ray_order", block.ray_order, names_of(ray_orders()));
    read_queries(reader, table, block);
    reader.list(table, "updates", block.updates,
                [&](const toml::node& node) { return reader.update(node); });
    reader.list(table, "builders", block.builders,
                [&](const toml::node& node) { return reader.builder(node); });
    reader.words(table, "layouts", block.layouts, names_of(layouts()));
    reader.words(table, "executors", block.executors, names_of(executors()));
    reader.list(table, "threads", block.threads,
                [&](const toml::node& node) { return reader.threads(node); });

    if (block.rays.empty() && std::ranges::any_of(block.tasks, is_ray_ask))
        reader.fail(table.source(), fmt::format("a ray ask needs rays: one or more of {}",
                                                fmt::join(names_of(ray_kinds()), ", ")));
    if (moves)
        return read_moving(reader, table, block);
    only_for(reader, table, false, "the asks of moving scenes",
             std::array{"effects", "frames", "updates", "stages", "without"});
    only_for(reader, table, std::ranges::any_of(block.tasks, is_ray_ask), "the asks of rays",
             std::array{"rays", "n_rays"});
    for (const SceneEntry& entry : scene_generators())
        if (!entry.has_mesh && std::ranges::find(block.scenes, entry.name) != block.scenes.end())
            for (const Ask ask : block.tasks)
                if (takes_kernel(ask) || ask == Ask::closest_points)
                    reader.fail(table.source(),
                                fmt::format("the scene \"{}\" has no triangles to {}", entry.name,
                                            is_ray_ask(ask) ? "aim rays at" : "test"));
    if (block.builders.empty() && block.peers.empty())
        reader.fail(table.source(), "[[cells]] needs builders, peers, or both");
}

Block read_block(const Reader& reader, const toml::table& table,
                 const std::vector<unsigned>& default_threads) {
    reader.require_known_keys(
        table, "[[cells]]",
        {"scene",   "n",      "overlaps", "rays",  "n_rays",   "ray_order", "effects", "frames",
         "updates", "stages", "without",  "task",   "builders", "layouts",   "kernels", "executors",
         "threads", "peers",  "k",        "scale", "n_points", "regions",   "rounds"});
    Block block;
    block.place = reader.place(table.source());
    block.threads = default_threads;
    reader.list(table, "task", block.tasks, [&](const toml::node& node) {
        return *ask_of(reader.word(node, "task", names_of(asks())));
    });
    if (!table.get("scene"))
        reader.fail(table.source(), "[[cells]] needs a scene, such as scene = \"uniform\"");
    if (block.tasks.empty())
        reader.fail(table.source(), fmt::format("[[cells]] needs an ask: one or more of {}",
                                                fmt::join(names_of(asks()), ", ")));
    reader.list(table, "n", block.n, [&](const toml::node& node) -> std::size_t {
        return reader.whole(node, "n", 1, 100'000'000);
    });
    reader.words(table, "peers", block.peers, peer_words());
    if (const toml::node* rounds = table.get("rounds"))
        block.rounds = static_cast<unsigned>(reader.whole(*rounds, "rounds", 1, 10'000));
    if (asks_kernels(reader, table, block))
        read_families(reader, table, block);
    else
        read_trees(reader, table, block);
    read_kernels(reader, table, block);
    if (block.scenes.empty())
        reader.fail(table.source(), "[[cells]] needs a scene, such as scene = \"uniform\"");
    return block;
}

} // namespace

std::vector<std::string> kernels_of(const Block& block, Ask ask) {
    const Words known = kernel_words(ask);
    const auto every = [&] { return std::vector<std::string>(known.begin(), known.end()); };
    if (!block.kernels)
        return is_ray_ask(ask) ? std::vector<std::string>{"watertight"} : every();
    return std::ranges::find(*block.kernels, "all") != block.kernels->end() ? every()
                                                                            : *block.kernels;
}

namespace {

Config read_config(const Reader& reader, std::string_view text) {
    const toml::table root = reader.parse(text);
    reader.require_known_keys(root, "a sweep file",
                              {"rounds", "min_time_ms", "delta", "seed", "threads", "cells"});
    Config config;
    if (const toml::node* node = root.get("rounds"))
        config.rounds = static_cast<unsigned>(reader.whole(*node, "rounds", 1, 10'000));
    if (const toml::node* node = root.get("min_time_ms"))
        config.min_time_ms = reader.number(*node, "min_time_ms", 0.001, 60'000);
    if (const toml::node* node = root.get("delta"))
        config.delta = reader.number(*node, "delta", 0, 1);
    if (const toml::node* node = root.get("seed"))
        config.seed = reader.whole(*node, "seed", 0, std::numeric_limits<std::int64_t>::max());
    std::vector<unsigned> threads{1};
    reader.list(root, "threads", threads,
                [&](const toml::node& node) { return reader.threads(node); });

    const toml::node* cells = root.get("cells");
    const toml::array* blocks = cells ? cells->as_array() : nullptr;
    if (!blocks || blocks->empty())
        throw BadInput(reader.file() + ": no [[cells]] block: there is nothing to measure");
    for (const toml::node& node : *blocks) {
        if (!node.is_table())
            reader.fail(node.source(), "cells must be [[cells]] blocks");
        config.blocks.push_back(read_block(reader, *node.as_table(), threads));
    }
    return config;
}

} // namespace

Config parse_config(std::string_view text, const std::string& file) {
    try {
        return read_config(Reader(file), text);
    } catch (const std::invalid_argument& error) {
        throw BadInput(error.what());
    }
}

} // namespace boxwood::bench
