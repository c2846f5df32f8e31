#include "bench/plan/block_reader.h"

#include "bench/io/bad_input.h"
#include "bench/plan/block_table.h"
#include "bench/plan/config_reader.h"
#include "trees/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace boxwood::bench {
namespace {

/// The reader's errors have their place already.
template <class Read> auto refusing(const Read& read) -> decltype(read()) {
    try {
        return read();
    } catch (const std::invalid_argument& error) {
        throw BadInput(error.what());
    }
}

/// "all", every peer library (found or not), and every contender of those that were found.
Names peer_names() {
    Names names{"all"};
    for (const Peer& peer : peers()) {
        names.push_back(peer.name);
        for (const ContenderEntry& contender : peer.contenders)
            if (contender.name != peer.name)
                names.push_back(contender.name);
    }
    for (const std::string_view name : absent_peers())
        names.emplace_back(name);
    return names;
}

/// Those names of a value that may be contenders of libraries that were not found: nobody knows.
std::vector<std::string> of_absent_peers(const toml::node* value) {
    std::vector<std::string> all;
    const auto take = [&](const toml::node& node) {
        const std::string name = node.value_or(std::string());
        for (const std::string_view library : absent_peers())
            if (name.starts_with(std::string(library) + "."))
                all.push_back(name);
    };
    if (value && value->is_array())
        for (const toml::node& node : *value->as_array())
            take(node);
    else if (value)
        take(*value);
    return all;
}

Place usual_place(unsigned threads) { return {std::string(default_executor(threads)), threads}; }

} // namespace

BlockReader::BlockReader(std::shared_ptr<const ConfigReader> reader,
                         std::shared_ptr<const Table> table)
    : reader_(std::move(reader)), table_(std::move(table)) {}

std::string BlockReader::place() const { return reader_->place(table_->toml.source()); }

Names BlockReader::keys() const {
    Names all;
    for (const auto& [key, value] : table_->toml)
        all.push_back(key.str());
    return all;
}

bool BlockReader::has(std::string_view key) const { return table_->toml.get(key) != nullptr; }

bool BlockReader::takes(std::string_view generator) const {
    const auto is_meant = [generator](const toml::node& node) {
        return node.value_or(std::string()) == generator;
    };
    const toml::node* scene = table_->toml.get("scene");
    const toml::array* all = scene ? scene->as_array() : nullptr;
    return all ? std::ranges::any_of(*all, is_meant) : scene && is_meant(*scene);
}

void BlockReader::fail(const std::string& message, std::string_view key) const {
    const toml::node* node = table_->toml.get(key);
    refusing([&] { reader_->fail(node ? node->source() : table_->toml.source(), message); });
    throw std::logic_error(message); // not reached: fail throws
}

std::vector<std::string> BlockReader::names(std::string_view key, const Names& known,
                                            std::vector<std::string> otherwise) const {
    refusing([&] { reader_->names(table_->toml, key, otherwise, known); });
    return otherwise;
}

std::vector<std::int64_t> BlockReader::integers(std::string_view key, std::int64_t min,
                                                std::int64_t max,
                                                std::vector<std::int64_t> otherwise) const {
    refusing([&] {
        reader_->list(table_->toml, key, otherwise, [&](const toml::node& node) {
            return static_cast<std::int64_t>(reader_->whole(node, key, min, max));
        });
    });
    return otherwise;
}

std::vector<double> BlockReader::numbers(std::string_view key, double min, double max,
                                         std::vector<double> otherwise) const {
    refusing([&] {
        reader_->list(table_->toml, key, otherwise,
                      [&](const toml::node& node) { return reader_->number(node, key, min, max); });
    });
    return otherwise;
}

std::vector<BuilderChoice> BlockReader::builders() const {
    std::vector<BuilderChoice> all;
    refusing([&] {
        reader_->list(table_->toml, "builders", all,
                      [&](const toml::node& node) { return reader_->builder(node); });
    });
    return all;
}

std::vector<BuilderChoice> BlockReader::choices(
    std::string_view key, std::string_view what, const Names& known,
    FunctionRef<void(const std::string& name, const Settings& settings)> try_out) const {
    std::vector<BuilderChoice> all;
    refusing([&] {
        reader_->list(table_->toml, key, all, [&](const toml::node& node) {
            return reader_->choice(
                node, what, [&](const toml::node& name) { return reader_->name(name, key, known); },
                try_out);
        });
    });
    return all;
}

std::vector<std::vector<EffectChoice>> BlockReader::effects() const {
    std::vector<std::vector<EffectChoice>> all;
    refusing([&] {
        reader_->list(table_->toml, "effects", all,
                      [&](const toml::node& node) { return reader_->effects(node); });
    });
    return all;
}

std::vector<std::string> BlockReader::moving_scenes() const {
    std::vector<std::string> all;
    refusing([&] {
        reader_->list(table_->toml, "scene", all,
                      [&](const toml::node& node) { return reader_->moving_scene(node); });
    });
    return all;
}

std::optional<std::uint64_t> BlockReader::integer(std::string_view key, std::int64_t min,
                                                  std::int64_t max) const {
    const toml::node* node = table_->toml.get(key);
    if (!node)
        return std::nullopt;
    return refusing([&] { return reader_->whole(*node, key, min, max); });
}

std::vector<std::size_t> BlockReader::sizes(std::vector<std::size_t> otherwise) const {
    if (!has("n"))
        return otherwise;
    const std::vector<std::int64_t> n = integers("n", 1, 100'000'000);
    return {n.begin(), n.end()};
}

std::vector<std::string> BlockReader::kernels(const Names& known,
                                              std::vector<std::string> otherwise) const {
    Names allowed{"all"};
    allowed.insert(allowed.end(), known.begin(), known.end());
    const std::vector<std::string> named = names("kernels", allowed, std::move(otherwise));
    return std::ranges::find(named, "all") == named.end()
               ? named
               : std::vector<std::string>(known.begin(), known.end());
}

std::vector<ContenderEntry> BlockReader::peers(std::string_view task) const {
    Names known = peer_names();
    const std::vector<std::string> absent = of_absent_peers(table_->toml.get("peers"));
    known.insert(known.end(), absent.begin(), absent.end());
    const std::vector<std::string> named = names("peers", known);
    const auto is_named = [&](std::string_view name) {
        return std::ranges::find(named, name) != named.end();
    };
    std::vector<ContenderEntry> chosen;
    for (const Peer& peer : bench::peers())
        for (const ContenderEntry& contender : peer.contenders)
            if (is_named(contender.name) ||
                ((is_named("all") || is_named(peer.name)) && contender.answers_task(task)))
                chosen.push_back(contender);
    return chosen;
}

std::vector<unsigned> BlockReader::threads() const {
    std::vector<unsigned> all = inputs_.threads;
    std::vector<unsigned> own = all;
    refusing([&] {
        reader_->list(table_->toml, "threads", own,
                      [&](const toml::node& node) { return reader_->threads(node); });
    });
    return inputs_.overrides_threads ? all : own;
}

std::vector<std::string> BlockReader::executor_names() const {
    Names known = names_of(executors());
    known.insert(known.end(), {device_executor, resident_executor, graph_executor});
    return names("executors", known);
}

std::vector<Place> BlockReader::places() const {
    const std::vector<std::string> named = executor_names();
    std::vector<Place> all;
    for (const unsigned n : threads()) {
        if (named.empty())
            all.push_back(usual_place(n));
        for (const std::string& executor : named)
            if (!is_device(executor) &&
                n <= entry_named(executor, executors(), "executor").max_threads)
                all.push_back({executor, n});
    }
    for (const Place& place : device_places())
        all.push_back(place);
    if (all.empty())
        fail(fmt::format("executors = \"{}\" has one thread, threads = {} have more: add 1 to "
                         "threads, or {} to executors",
                         fmt::join(named, ", "), fmt::join(threads(), ", "), default_executor(2)),
             "executors");
    return all;
}

std::vector<Place> BlockReader::device_places() const {
    std::vector<Place> all;
    for (const std::string& executor : executor_names())
        if (is_device(executor))
            all.push_back({executor, 1});
    return all;
}

std::vector<Place> BlockReader::usual_places() const {
    std::vector<Place> all;
    for (const unsigned n : threads())
        all.push_back(usual_place(n));
    return all;
}

} // namespace boxwood::bench
