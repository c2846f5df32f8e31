#include "bench/plan/config.h"

#include "bench/io/bad_input.h"
#include "bench/plan/block_table.h"
#include "bench/plan/config_reader.h"
#include "bench/tasks/instruction_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace boxwood::bench {
namespace {

constexpr std::string_view native = "native"; ///< as an instruction set: the processor's best

/// Of every [[cells]] block.
const Names common_keys{"task", "rounds", "isa", "cold_build"};

bool takes(const Task& task, std::string_view key) {
    return std::ranges::count(task.keys(), key) > 0;
}

Names task_names() {
    Names names;
    for (const Task* task : tasks())
        names.push_back(task->name());
    return names;
}

/// Of all tasks.
Names known_keys() {
    Names known = common_keys;
    for (const Task* task : tasks())
        for (const std::string_view key : task->keys())
            if (std::ranges::find(known, key) == known.end())
                known.push_back(key);
    return known;
}

/// The keys of a table are known, and none is an empty list, which would leave nothing to measure.
void check_keys(const ConfigReader& reader, const toml::table& table, std::string_view where,
                const Names& known) {
    reader.require_known_keys(table, where, known);
    for (const auto& [key, value] : table)
        if (const toml::array* list = value.as_array(); list && list->empty() && key != "cells")
            reader.fail(value.source(),
                        fmt::format("{} = [] names nothing: give one value or more, or leave the "
                                    "key out",
                                    key.str()));
}

/// One of the block's tasks takes each key.
void require_takers(const BlockReader& reader, const std::vector<const Task*>& block_tasks) {
    for (const std::string_view key : reader.keys()) {
        if (std::ranges::find(common_keys, key) != common_keys.end() ||
            std::ranges::any_of(block_tasks, [&](const Task* task) { return takes(*task, key); }))
            continue;
        Names takers;
        for (const Task* task : tasks())
            if (takes(*task, key))
                takers.push_back(task->name());
        reader.fail(fmt::format("{} is for the task{} {}", key, takers.size() == 1 ? "" : "s",
                                fmt::join(takers, ", ")),
                    key);
    }
}

std::string_view text_of(SceneKind kind) {
    return kind == SceneKind::still    ? "generators of scenes that stand still"
           : kind == SceneKind::moving ? "moving scenes"
                                       : "families of hard cases";
}

Block read_block(const std::shared_ptr<const ConfigReader>& reader,
                 const std::shared_ptr<const toml::table>& root, const toml::table& table) {
    check_keys(*reader, table, "[[cells]]", known_keys());
    Block block{
        {reader, std::make_shared<const BlockReader::Table>(BlockReader::Table{root, table})},
        {},
        {}};
    reader->list(table, "task", block.tasks, [&](const toml::node& node) {
        return find_task(reader->name(node, "task", task_names()));
    });
    if (block.tasks.empty()) {
        reader->fail(table.source(), fmt::format("[[cells]] needs a task: one or more of {}",
                                                 fmt::join(task_names(), ", ")));
    }
    require_takers(block.reader, block.tasks);
    const Task& first = *block.tasks.front();
    for (const Task* task : block.tasks)
        if (task->scenes() != first.scenes())
            reader->fail(table.source(),
                         fmt::format("{} takes {} and {} {}: they need [[cells]] blocks of their "
                                     "own",
                                     first.name(), text_of(first.scenes()), task->name(),
                                     text_of(task->scenes())));
    if (!table.get("scene"))
        reader->fail(table.source(), "[[cells]] needs a scene, such as scene = \"uniform\"");
    if (const toml::node* rounds = table.get("rounds"))
        block.rounds = static_cast<unsigned>(reader->whole(*rounds, "rounds", 1, 10'000));
    if (const toml::node* cold = table.get("cold_build")) {
        if (!cold->is_boolean())
            reader->fail(cold->source(), "cold_build must be true or false");
        block.cold_build = cold->value_or(false);
    }
    if (const toml::node* cold = table.get("cold_caches")) {
        if (!cold->is_boolean())
            reader->fail(cold->source(), "cold_caches must be true or false");
        block.cold_caches = cold->value_or(false);
    }
    if (table.get("isa")) {
        Names known(instruction_sets().begin(), instruction_sets().end());
        known.emplace_back(native);
        block.instruction_sets = block.reader.names("isa", known);
        std::ranges::replace(block.instruction_sets, std::string(native), std::string());
    }
    return block;
}

Config read_config(const std::shared_ptr<const ConfigReader>& shared, std::string_view text) {
    const ConfigReader& reader = *shared;
    const auto shared_root = std::make_shared<const toml::table>(reader.parse(text));
    const toml::table& root = *shared_root;
    check_keys(reader, root, "a sweep file",
               {"rounds", "min_time_ms", "delta", "seed", "inputs", "threads", "cells"});
    Config config;
    if (const toml::node* node = root.get("rounds"))
        config.rounds = static_cast<unsigned>(reader.whole(*node, "rounds", 1, 10'000));
    if (const toml::node* node = root.get("min_time_ms"))
        config.min_time_ms = reader.number(*node, "min_time_ms", 0.001, 60'000);
    if (const toml::node* node = root.get("delta"))
        config.delta = reader.number(*node, "delta", 0, 1);
    if (const toml::node* node = root.get("seed"))
        config.seed = reader.whole(*node, "seed", 0, std::numeric_limits<std::int64_t>::max());
    if (const toml::node* node = root.get("inputs"))
        config.inputs = static_cast<unsigned>(reader.whole(*node, "inputs", 1, 1000));
    reader.list(root, "threads", config.threads,
                [&](const toml::node& node) { return reader.threads(node); });

    const toml::node* cells = root.get("cells");
    const toml::array* blocks = cells ? cells->as_array() : nullptr;
    if (!blocks || blocks->empty())
        throw BadInput(reader.file() + ": no [[cells]] block: there is nothing to measure");
    for (const toml::node& node : *blocks) {
        if (!node.is_table())
            reader.fail(node.source(), "cells must be [[cells]] blocks");
        config.blocks.push_back(read_block(shared, shared_root, *node.as_table()));
    }
    return config;
}

} // namespace

Config parse_config(std::string_view text, const std::string& file) {
    try {
        return read_config(std::make_shared<const ConfigReader>(file), text);
    } catch (const std::invalid_argument& error) {
        throw BadInput(error.what());
    }
}

} // namespace boxwood::bench
