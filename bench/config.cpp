#include "bench/config.h"

#include "bench/commands/command.h"
#include "kernels/catalogue.h"
#include "scenes/scene.h"
#include "scenes/suggest.h"
#include "trees/layout.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
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

    BuilderChoice builder(const toml::node& node) const {
        const Words known = names_of(builders());
        if (node.is_string())
            return {word(node, "builders", known), {}};
        const toml::table* table = node.as_table();
        const toml::node* name = table ? table->get("name") : nullptr;
        if (!name)
            fail(node.source(), "a builder is a word, or {name = \"WORD\", SETTING = NUMBER, ...}");
        BuilderChoice choice{word(*name, "builders", known), {}};
        for (const auto& [key, value] : *table)
            if (key != "name")
                choice.settings[std::string(key.str())] = number(value, key.str(), -1e300, 1e300);
        try {
            find_builder(choice.name)->make(choice.settings);
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

Block read_block(const Reader& reader, const toml::table& table,
                 const std::vector<unsigned>& default_threads) {
    reader.require_known_keys(table, "[[cells]]",
                              {"scene", "n", "overlaps", "rays", "n_rays", "ask", "builders",
                               "layouts", "kernels", "executors", "threads", "peers"});
    Block block;
    block.place = reader.place(table.source());
    block.threads = default_threads;
    reader.words(table, "scene", block.scenes, names_of(scene_generators()));
    if (block.scenes.empty())
        reader.fail(table.source(), "[[cells]] needs a scene, such as scene = \"uniform\"");
    const bool has_mesh = std::ranges::find(block.scenes, "mesh") != block.scenes.end();
    if (has_mesh && block.scenes.size() > 1)
        reader.fail(table.source(), "the scene \"mesh\" needs a [[cells]] block of its own");
    if (const toml::node* n = table.get("n"); n && has_mesh)
        reader.fail(n->source(), "the scene \"mesh\" takes no n: the size is that of its file");

    reader.list(table, "n", block.n, [&](const toml::node& node) -> std::size_t {
        return reader.whole(node, "n", 1, 100'000'000);
    });
    reader.list(table, "overlaps", block.overlaps,
                [&](const toml::node& node) { return reader.number(node, "overlaps", 0, 1e6); });
    reader.words(table, "rays", block.rays, names_of(ray_kinds()));
    if (const toml::node* n_rays = table.get("n_rays"))
        block.n_rays = reader.whole(*n_rays, "n_rays", 1, 1'000'000'000);
    reader.list(table, "ask", block.asks, [&](const toml::node& node) {
        return *ask_of(reader.word(node, "ask", names_of(asks())));
    });
    reader.list(table, "builders", block.builders,
                [&](const toml::node& node) { return reader.builder(node); });
    reader.words(table, "layouts", block.layouts, names_of(layouts()));
    reader.words(table, "kernels", block.kernels, names_of(ray_kernels()));
    reader.words(table, "executors", block.executors, names_of(executors()));
    reader.list(table, "threads", block.threads,
                [&](const toml::node& node) { return reader.threads(node); });
    reader.words(table, "peers", block.peers, peer_words());

    if (block.asks.empty())
        reader.fail(table.source(), fmt::format("[[cells]] needs an ask: one or more of {}",
                                                fmt::join(names_of(asks()), ", ")));
    if (block.rays.empty() && std::ranges::any_of(block.asks, is_ray_ask))
        reader.fail(table.source(), fmt::format("a ray ask needs rays: one or more of {}",
                                                fmt::join(names_of(ray_kinds()), ", ")));
    for (const SceneEntry& entry : scene_generators())
        if (!entry.has_mesh && std::ranges::find(block.scenes, entry.name) != block.scenes.end() &&
            std::ranges::any_of(block.asks, is_ray_ask))
            reader.fail(
                table.source(),
                fmt::format("the scene \"{}\" has no triangles to aim rays at", entry.name));
    if (block.builders.empty() && block.peers.empty())
        reader.fail(table.source(), "[[cells]] needs builders, peers, or both");
    return block;
}

} // namespace

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
