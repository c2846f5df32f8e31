#include "bench/commands/list.h"

#include "bench/commands/command.h"
#include "bench/commands/devices.h"
#include "bench/io/json.h"
#include "bench/io/text_table.h"
#include "bench/tasks/task.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"
#include "scenes/effects/effect.h"
#include "scenes/hard_cases/hard_cases.h"
#include "scenes/moving/scene_file.h"
#include "trees/builder.h"
#include "trees/dynamic/update.h"
#include "trees/layout.h"
#include "trees/world/mesh_tree.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <iostream>
#include <sstream>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

/// One name of a registry; `more` holds further JSON members, `notes` further indented lines.
struct Row {
    std::string name, summary;
    std::vector<std::pair<std::string, std::string>> more;
    std::vector<std::string> notes;
};
using Rows = std::vector<Row>;

/// The rows of a registry whose entries have a name and a summary alone.
template <class Entries> Rows plain(const Entries& entries) {
    Rows rows;
    for (const auto& entry : entries)
        rows.push_back({std::string(entry.name), std::string(entry.summary), {}, {}});
    return rows;
}

std::string default_json(const SettingInfo& setting) {
    const auto* name = std::get_if<std::string>(&setting.default_value);
    return name ? json_string(*name) : to_text(setting.default_value);
}

/// The choices of a setting, or its range.
std::string allowed_json(const SettingInfo& setting) {
    if (std::holds_alternative<bool>(setting.default_value))
        return "\"choices\":[true,false]";
    if (setting.choices.empty())
        return fmt::format("\"min\":{},\"max\":{}", json_number(setting.min),
                           json_number(setting.max));
    std::string names;
    for (const std::string_view choice : setting.choices)
        names += (names.empty() ? "" : ",") + json_string(choice);
    return "\"choices\":[" + names + "]";
}

/// ... and its settings.
template <class Entries> Rows with_settings(const Entries& entries) {
    Rows rows = plain(entries);
    for (Row& row : rows) {
        const auto entry = std::ranges::find_if(
            entries, [&row](const auto& candidate) { return candidate.name == row.name; });
        std::string settings;
        for (const SettingInfo& s : entry->settings) {
            settings += fmt::format("{}{{\"name\":{},\"summary\":{},\"default\":{},{}}}",
                                    settings.empty() ? "" : ",", json_string(s.name),
                                    json_string(s.summary), default_json(s), allowed_json(s));
            row.notes.push_back(fmt::format("{} = {} ({}): {}", s.name, to_text(s.default_value),
                                            allowed_values(s), s.summary));
        }
        row.more.emplace_back("settings", "[" + settings + "]");
    }
    return rows;
}

Row kernel_row(const KernelInfo& kernel) {
    return {std::string(kernel.name),
            fmt::format("{}, {}: {}", kernel.family, to_string(kernel.promise), kernel.summary),
            {{"family", json_string(kernel.family)},
             {"promise", json_string(to_string(kernel.promise))},
             {"bound", json_string(kernel.bound)},
             {"cost", json_string(kernel.cost)}},
            {fmt::format("bound: {}", kernel.bound), fmt::format("cost: {}", kernel.cost)}};
}

/// First the kernels that have no task of their own; then family by family, the rational ones last.
Rows kernel_rows() {
    Rows rows;
    for (const KernelInfo& kernel : kernels())
        if (!find_task(kernel.family))
            rows.push_back(kernel_row(kernel));
    for (const Task* task : tasks())
        for (const KernelInfo& kernel : task->kernels())
            rows.push_back(kernel_row(kernel));
    return rows;
}

Rows task_rows() {
    Rows rows;
    for (const Task* task : tasks())
        rows.push_back({std::string(task->name()), std::string(task->summary()), {}, {}});
    return rows;
}

Rows peer_rows() {
    Rows rows;
    for (const Peer& peer : peers()) {
        Row& row = rows.emplace_back(Row{peer.name,
                                         fmt::format("{} ({}{}{})", peer.summary, peer.version,
                                                     peer.build.empty() ? "" : "; ", peer.build),
                                         {},
                                         {}});
        std::string contenders;
        for (const ContenderEntry& c : peer.contenders) {
            contenders += fmt::format("{}{{\"name\":{},\"summary\":{},\"notes\":{}}}",
                                      contenders.empty() ? "" : ",", json_string(c.name),
                                      json_string(c.summary), json_string(c.notes));
            row.notes.push_back(c.name + ": " + c.summary);
        }
        row.more = {{"present", "true"},
                    {"version", json_string(peer.version)},
                    {"build", json_string(peer.build)},
                    {"contenders", "[" + contenders + "]"}};
    }
    for (const std::string_view name : absent_peers())
        rows.push_back({std::string(name),
                        "absent: it was not found when boxwood was built "
                        "(bench/peers/README.md says how to get it)",
                        {{"present", "false"}},
                        {}});
    return rows;
}

Rows family_rows() {
    Rows rows;
    for (const HardCaseFamily& family : hard_case_families()) {
        const bool has_k = !family.k_meaning.empty();
        const std::string k = fmt::format("{{\"meaning\":{},\"default\":{},\"min\":{},\"max\":{}}}",
                                          json_string(family.k_meaning), family.k_default,
                                          family.k_min, family.k_max);
        const std::string scale =
            fmt::format("{{\"min\":{},\"max\":{}}}", family.scale_min, family.scale_max);
        Row& row =
            rows.emplace_back(Row{std::string(family.name),
                                  fmt::format("{}: {}", to_string(family.panel), family.summary),
                                  {{"panel", json_string(to_string(family.panel))},
                                   {"k", has_k ? k : "null"},
                                   {"scale", scale},
                                   {"reads_file", family.reads_file ? "true" : "false"}},
                                  {}});
        if (has_k)
            row.notes.push_back(fmt::format("k = {} ({} to {}): {}", family.k_default, family.k_min,
                                            family.k_max, family.k_meaning));
        if (family.scale_min != family.scale_max)
            row.notes.push_back(fmt::format("scale = {} to {} (coordinates times 2^scale)",
                                            family.scale_min, family.scale_max));
    }
    return rows;
}

Rows moving_scene_rows() {
    Rows rows;
    for (const BuiltInScene& scene : built_in_scenes()) {
        std::string name(scene.name);
        std::string summary = load_scene(name).summary;
        rows.push_back({std::move(name), std::move(summary), {}, {}});
    }
    return rows;
}

Rows device_rows() {
    Rows rows;
    for (const Device& device : devices())
        rows.push_back({device_name(device),
                        device_summary(device),
                        {{"memory_bytes", std::to_string(device.memory_bytes)},
                         {"multiprocessors", std::to_string(device.multiprocessors)},
                         {"driver", std::to_string(device.driver)},
                         {"runtime", std::to_string(device.runtime)}},
                        {}});
    return rows;
}

/// With the default, which is the first.
Rows volume_rows() {
    Rows rows;
    for (const MeshVolumeEntry& volume : mesh_volumes()) {
        const bool is_default = &volume == &mesh_volumes().front();
        rows.push_back({std::string(volume.name),
                        fmt::format("{}{}", volume.summary, is_default ? " (the default)" : ""),
                        {{"default", is_default ? "true" : "false"}},
                        {}});
    }
    return rows;
}

struct Registry {
    std::string_view name, summary;
    Rows (*rows)();
    std::string (*why_empty)() = nullptr; ///< of one that may have no rows
};

constexpr std::array registries{
    Registry{"builders", "build a tree from boxes", [] { return with_settings(builders()); }},
    Registry{"optimizers", "improve a tree: BUILDER+OPTIMIZER",
             [] { return with_settings(optimizers()); }},
    Registry{"layouts", "store a tree in memory", [] { return plain(layouts()); }},
    Registry{"volumes", "enclose the parts of a mesh", volume_rows},
    Registry{"queries", "what a layout can be searched for", [] { return plain(traversals()); }},
    Registry{"updates", "follow boxes that move", [] { return with_settings(updates()); }},
    Registry{"executors", "run work on threads", [] { return plain(executors()); }},
    Registry{"devices", "run work on a GPU", device_rows, why_no_device},
    Registry{"kernels", "decide one primitive or pair", kernel_rows},
    Registry{"families", "hard cases for kernels", family_rows},
    Registry{"scenes", "generate boxes and meshes", [] { return plain(scene_generators()); }},
    Registry{"moving_scenes", "bodies that move: `boxwood scene`", moving_scene_rows},
    Registry{"effects", "what happens to the bodies of a scene",
             [] { return with_settings(effects()); }},
    Registry{"scene_queries", "what a scene wants of each frame",
             [] { return plain(scene_queries()); }},
    Registry{"query_kinds", "where its queries lie", [] { return plain(query_kinds()); }},
    Registry{"tasks", "what the bench times", task_rows},
    Registry{"peers", "libraries compared with ours", peer_rows},
};

/// Behind `lead`, in lines of at most 100 columns; what follows the first is indented further.
std::string wrapped(std::string lead, std::string_view text) {
    constexpr std::size_t columns = 100;
    const std::string indent(lead.size() + 2, ' ');
    std::string lines, line = std::move(lead);
    std::istringstream words{std::string(text)};
    bool starts_line = true;
    for (std::string word; words >> word; starts_line = false) {
        if (!starts_line && line.size() + 1 + word.size() > columns) {
            lines += line + '\n';
            line = indent;
            starts_line = true;
        }
        line += (starts_line ? "" : " ") + word;
    }
    return lines + line + '\n';
}

std::string as_text(const Registry& registry) {
    const Rows rows = registry.rows();
    if (rows.empty())
        return wrapped("none: ", registry.why_empty());
    std::size_t width = 0;
    for (const Row& row : rows)
        width = std::max(width, row.name.size());
    std::string text;
    for (const Row& row : rows) {
        text += wrapped(fmt::format("{:<{}}  ", row.name, width), row.summary);
        for (const std::string& note : row.notes)
            text += wrapped(std::string(width + 4, ' '), note);
    }
    return text;
}

std::string as_json(const Registry& registry) {
    std::string text;
    for (const Row& row : registry.rows()) {
        text += fmt::format("{}{{\"name\":{},\"summary\":{}", text.empty() ? "" : ",",
                            json_string(row.name), json_string(row.summary));
        for (const auto& [key, value] : row.more)
            text += fmt::format(",{}:{}", json_string(key), value);
        text += "}";
    }
    return "[" + text + "]";
}

/// The names from the first on, as many as fit; "..." where some are left out.
std::string first_names(const Rows& rows, std::size_t width) {
    std::string text;
    for (const Row& row : rows) {
        const std::string next = (text.empty() ? "" : ", ") + row.name;
        const bool is_last = &row == &rows.back();
        if (text.size() + next.size() + (is_last ? 0 : 5) > width)
            return text + ", ...";
        text += next;
    }
    return text;
}

/// A line per registry: how many names, what they are for, and the first of them.
std::string summary_text() {
    constexpr std::size_t names_width = 38;
    TextTable table({"registry", ">names", "what they do", "the first"});
    for (const Registry& registry : registries) {
        const Rows rows = registry.rows();
        table.add({std::string(registry.name), std::to_string(rows.size()),
                   std::string(registry.summary),
                   rows.empty() ? fmt::format("none: `boxwood list {}` says why", registry.name)
                                : first_names(rows, names_width)});
    }
    return table.text() + "\n`boxwood list builders` explains each name of a registry.\n";
}

std::string summary_json() {
    std::string text;
    for (const Registry& registry : registries)
        text += fmt::format("{}{}:{}", text.empty() ? "{" : ",\n ", json_string(registry.name),
                            as_json(registry));
    return text + "}\n";
}

} // namespace

std::span<const std::string_view> registry_names() {
    static const std::vector<std::string_view> names = names_of(registries);
    return names;
}

std::string list_text(std::string_view name, bool json) {
    if (name.empty())
        return json ? summary_json() : summary_text();
    const Registry& registry = entry_named<Registry>(name, registries, "registry");
    return json ? as_json(registry) + "\n" : as_text(registry);
}

void add_list(CLI::App& app, int&) {
    struct Options {
        std::string registry;
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* list = app.add_subcommand(
        "list", "what boxwood is made of: a summary, or one registry with a line for each name");
    list->add_option(
        "registry", options->registry,
        fmt::format("one of {}; a summary of all if not given", fmt::join(registry_names(), ", ")));
    list->add_flag("--json", options->json,
                   "a list of {\"name\",\"summary\"}; for all registries an object of such lists");
    list->footer("Examples:\n"
                 "  boxwood list                 how many names each registry has, and the first\n"
                 "  boxwood list builders        every builder with its settings");
    list->callback([options] { std::cout << list_text(options->registry, options->json); });
}

} // namespace boxwood::bench
