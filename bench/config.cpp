#include "bench/config.h"

#include "bench/commands/command.h"
#include "bench/families.h"
#include "bench/rays.h"
#include "bench/rungs/rungs.h"
#include "kernels/catalogue.h"
#include "scenes/queries.h"
#include "scenes/scene.h"
#include "scenes/suggest.h"
#include "trees/layout.h"
#include "trees/update.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <limits>
#include <thread>

namespace boxwood::bench {
namespace {

using Words = std::vector<std::string_view>;

template <class Entries> Words names_of(const Entries& entries) {
    Words words;
    for (const auto& entry : entries)
        words.emplace_back(entry.name);
    return words;
}

/// "all", every peer library (found or not), and every contender of those that were found.
Words peer_words() {
    Words words{"all"};
    for (const Peer& peer : peers()) {
        words.push_back(peer.name);
        for (const ContenderEntry& contender : peer.contenders)
            words.push_back(contender.name);
    }
    for (const std::string_view name : absent_peers())
        words.emplace_back(name);
    return words;
}

/// Reads typed values out of a table and says where a bad one stands.
class Reader {
  public:
    explicit Reader(std::string file) : file_(std::move(file)) {}

    std::string place(const toml::source_region& source) const {
        return fmt::format("{}:{}", file_, source.begin.line);
    }

    [[noreturn]] void fail(const toml::source_region& source, const std::string& message) const {
        throw BadInput(place(source) + ": " + message);
    }

    void require_known_keys(const toml::table& table, std::string_view where,
                            const Words& known) const {
        for (const auto& [key, value] : table)
            if (std::ranges::find(known, key.str()) == known.end())
                fail(key.source(), unknown_word(fmt::format("key of {}", where), key.str(), known));
    }

    double number(const toml::node& node, std::string_view key, double least, double most) const {
        const auto value = node.value<double>();
        if (!value || !node.is_number())
            fail(node.source(), fmt::format("{} must be a number", key));
        if (!(*value >= least && *value <= most))
            fail(node.source(),
                 fmt::format("{} = {} is out of range: it must lie between {} and {}", key, *value,
                             least, most));
        return *value;
    }

    std::uint64_t whole(const toml::node& node, std::string_view key, std::int64_t least,
                        std::int64_t most) const {
        if (!node.is_integer())
            fail(node.source(), fmt::format("{} must be a whole number", key));
        const std::int64_t value = *node.value<std::int64_t>();
        if (value < least || value > most)
            fail(node.source(),
                 fmt::format("{} = {} is out of range: it must lie between {} and {}", key, value,
                             least, most));
        return static_cast<std::uint64_t>(value);
    }

    std::string word(const toml::node& node, std::string_view key, const Words& known) const {
        const auto value = node.value<std::string>();
        if (!value)
            fail(node.source(), fmt::format("{} must be a word in quotes", key));
        if (std::ranges::find(known, *value) == known.end())
            fail(node.source(), fmt::format("{}: {}", key, unknown_word("word", *value, known)));
        return *value;
    }

    unsigned threads(const toml::node& node) const {
        if (node.is_string()) {
            word(node, "threads", {"all"});
            return std::max(1u, std::thread::hardware_concurrency());
        }
        return static_cast<unsigned>(whole(node, "threads", 1, 1024));
    }

    /// "ploc", or with a stage after it "ploc+reinsertion".
    std::string builder_words(const toml::node& node) const {
        const std::string words = node.value_or(std::string());
        const std::size_t plus = words.find('+');
        if (!node.is_string() || plus == std::string::npos)
            return word(node, "builders", names_of(builders()));
        word(toml::value<std::string>(words.substr(0, plus)), "builders", names_of(builders()));
        word(toml::value<std::string>(words.substr(plus + 1)), "stages", names_of(stages()));
        return words;
    }

    BuilderChoice builder(const toml::node& node) const {
        if (node.is_string())
            return {builder_words(node), {}};
        const toml::table* table = node.as_table();
        const toml::node* name = table ? table->get("name") : nullptr;
        if (!name)
            fail(node.source(), "a builder is a word, or {name = \"WORD\", SETTING = NUMBER, ...}");
        BuilderChoice choice{builder_words(*name), {}};
        for (const auto& [key, value] : *table)
            if (key != "name")
                choice.settings[std::string(key.str())] = number(value, key.str(), -1e300, 1e300);
        try {
            make_builder(choice.name, choice.settings);
        } catch (const std::invalid_argument& error) {
            fail(node.source(), error.what());
        }
        return choice;
    }

    /// "refit", or `{name = "rebuild", trigger = 1.3}`.
    BuilderChoice update(const toml::node& node) const {
        if (node.is_string())
            return {word(node, "updates", names_of(boxwood::updates())), {}};
        const toml::table* table = node.as_table();
        const toml::node* name = table ? table->get("name") : nullptr;
        if (!name)
            fail(node.source(), "an update is a word, or {name = \"WORD\", SETTING = NUMBER, ...}");
        BuilderChoice choice{word(*name, "updates", names_of(boxwood::updates())), {}};
        for (const auto& [key, value] : *table)
            if (key != "name")
                choice.settings[std::string(key.str())] = number(value, key.str(), -1e300, 1e300);
        try {
            find_update(choice.name)->make(choice.settings);
        } catch (const std::invalid_argument& error) {
            fail(node.source(), error.what());
        }
        return choice;
    }

    /// Replaces `out` by what `read` makes of the value of `key`, or of each element if it is a
    /// list.
    template <class T, class Read>
    void list(const toml::table& table, std::string_view key, std::vector<T>& out,
              Read read) const {
        const toml::node* node = table.get(key);
        if (!node)
            return;
        out.clear();
        if (const toml::array* array = node->as_array())
            for (const toml::node& element : *array)
                out.push_back(read(element));
        else
            out.push_back(read(*node));
    }

    void words(const toml::table& table, std::string_view key, std::vector<std::string>& out,
               const Words& known) const {
        list(table, key, out, [&](const toml::node& node) { return word(node, key, known); });
    }

  private:
    std::string file_;
};

/// What a `kernels` key may say for an ask; empty if it takes none.
Words kernel_words(Ask ask) {
    return is_kernel_ask(ask)           ? names_of(rungs(ask))
           : is_ray_ask(ask)            ? names_of(ray_kernels())
           : ask == Ask::triangle_pairs ? names_of(triangle_kernels())
                                        : Words{};
}

/// Keys that only kernel asks take, and those that only the others do.
constexpr std::array kernel_keys{"scale"};
constexpr std::array tree_keys{"motion",    "frames",   "updates", "overlaps",  "rays",   "n_rays",
                               "ray_order", "builders", "layouts", "executors", "threads"};
constexpr std::array point_keys{"n_points", "regions"};

/// The asks of a block are all kernel asks or none is.
bool asks_kernels(const Reader& reader, const toml::table& table, const Block& block) {
    const bool some = std::ranges::any_of(block.asks, is_kernel_ask);
    if (some && !std::ranges::all_of(block.asks, is_kernel_ask))
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
        k && !some && std::ranges::find(block.asks, Ask::nearest) == block.asks.end())
        reader.fail(k->source(), "k is for the asks of kernels and for nearest");
    return some;
}

void read_kernels(const Reader& reader, const toml::table& table, Block& block) {
    const toml::node* node = table.get("kernels");
    if (!node)
        return;
    Words known{"all"};
    for (const Ask ask : block.asks)
        for (const std::string_view word : kernel_words(ask))
            if (std::ranges::find(known, word) == known.end())
                known.push_back(word);
    if (known.size() == 1)
        reader.fail(node->source(),
                    fmt::format("the ask {} takes no kernels", to_string(block.asks.front())));
    reader.words(table, "kernels", block.kernels.emplace(), known);
    for (const Ask ask : block.asks)
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
        for (const Ask ask : block.asks) {
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
    if (n_points && std::ranges::none_of(block.asks, is_point_ask))
        reader.fail(n_points->source(), "n_points is for the asks of points and regions");
    if (n_points)
        block.n_points = reader.whole(*n_points, "n_points", 1, 1'000'000'000);
    if (const toml::node* regions = table.get("regions");
        regions && std::ranges::find(block.asks, Ask::regions) == block.asks.end())
        reader.fail(regions->source(), "regions is for the ask regions");
    reader.words(table, "regions", block.regions, names_of(region_kinds()));
    reader.list(table, "k", block.k, [&](const toml::node& node) {
        return static_cast<int>(reader.whole(node, "k", 1, 1000));
    });
}

/// The keys of a block of asks of trees.
void read_trees(const Reader& reader, const toml::table& table, Block& block) {
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
        order && std::ranges::none_of(block.asks, has_ray_order))
        reader.fail(order->source(), "ray_order is for the asks rays_closest and rays_any");
    reader.words(table, "ray_order", block.ray_order, names_of(ray_orders()));
    read_queries(reader, table, block);
    reader.words(table, "motion", block.motions, names_of(motions()));
    if (const toml::node* frames = table.get("frames"))
        block.n_frames = reader.whole(*frames, "frames", 1, 100'000);
    reader.list(table, "updates", block.updates,
                [&](const toml::node& node) { return reader.update(node); });
    reader.list(table, "builders", block.builders,
                [&](const toml::node& node) { return reader.builder(node); });
    reader.words(table, "layouts", block.layouts, names_of(layouts()));
    reader.words(table, "executors", block.executors, names_of(executors()));
    reader.list(table, "threads", block.threads,
                [&](const toml::node& node) { return reader.threads(node); });

    if (block.rays.empty() && std::ranges::any_of(block.asks, is_ray_ask))
        reader.fail(table.source(), fmt::format("a ray ask needs rays: one or more of {}",
                                                fmt::join(names_of(ray_kinds()), ", ")));
    const bool moves = std::ranges::find(block.asks, Ask::moving_pairs) != block.asks.end();
    if (moves && block.motions.empty())
        reader.fail(table.source(), fmt::format("moving_pairs needs a motion: one or more of {}",
                                                fmt::join(names_of(motions()), ", ")));
    if (!moves && !block.updates.empty())
        reader.fail(table.get("updates")->source(), "updates is for the ask moving_pairs");
    for (const SceneEntry& entry : scene_generators())
        if (!entry.has_mesh && std::ranges::find(block.scenes, entry.name) != block.scenes.end())
            for (const Ask ask : block.asks)
                if (takes_kernel(ask) || ask == Ask::closest_points)
                    reader.fail(table.source(),
                                fmt::format("the scene \"{}\" has no triangles to {}", entry.name,
                                            is_ray_ask(ask) ? "aim rays at" : "test"));
    if (block.builders.empty() && block.updates.empty() && block.peers.empty())
        reader.fail(table.source(), moves ? "[[cells]] needs updates, peers, or both"
                                          : "[[cells]] needs builders, peers, or both");
}

Block read_block(const Reader& reader, const toml::table& table,
                 const std::vector<unsigned>& default_threads) {
    reader.require_known_keys(table, "[[cells]]",
                              {"scene",     "n",       "overlaps", "rays",      "n_rays",
                               "ray_order", "motion",  "frames",   "updates",   "ask",
                               "builders",  "layouts", "kernels",  "executors", "threads",
                               "peers",     "k",       "scale",    "n_points",  "regions"});
    Block block;
    block.place = reader.place(table.source());
    block.threads = default_threads;
    reader.list(table, "ask", block.asks, [&](const toml::node& node) {
        return *ask_of(reader.word(node, "ask", names_of(asks())));
    });
    if (!table.get("scene"))
        reader.fail(table.source(), "[[cells]] needs a scene, such as scene = \"uniform\"");
    if (block.asks.empty())
        reader.fail(table.source(), fmt::format("[[cells]] needs an ask: one or more of {}",
                                                fmt::join(names_of(asks()), ", ")));
    reader.list(table, "n", block.n, [&](const toml::node& node) -> std::size_t {
        return reader.whole(node, "n", 1, 100'000'000);
    });
    reader.words(table, "peers", block.peers, peer_words());
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

Config parse_config(std::string_view text, const std::string& file) {
    const Reader reader(file);
    toml::table root;
    try {
        root = toml::parse(text);
    } catch (const toml::parse_error& error) {
        reader.fail(error.source(), fmt::format("not TOML: {}", error.description()));
    }
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
        throw BadInput(file + ": no [[cells]] block: there is nothing to measure");
    for (const toml::node& node : *blocks) {
        if (!node.is_table())
            reader.fail(node.source(), "cells must be [[cells]] blocks");
        config.blocks.push_back(read_block(reader, *node.as_table(), threads));
    }
    return config;
}

} // namespace boxwood::bench
