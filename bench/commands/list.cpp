#include "bench/commands/list.h"

#include "bench/commands/command.h"
#include "bench/tasks/contender.h"
#include "bench/io/json.h"
#include "bench/tasks/kernels/kernels.h"
#include "kernels/registry.h"
#include "scenes/hard_cases/hard_cases.h"
#include "scenes/effects/effect.h"
#include "scenes/moving/scene_file.h"
#include "kernels/suggest.h"
#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/dynamic/update.h"

#include <algorithm>
#include <array>
#include <iostream>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

/// One line of a registry; `more` holds further JSON members, `notes` further indented lines.
struct Row {
    std::string name, summary;
    std::vector<std::pair<std::string, std::string>> more;
    std::vector<std::string> notes;
};
using Rows = std::vector<Row>;

/// The rows of a registry of which no more is said than name and summary.
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

/// Family by family, the rational rungs last; first what no question of its own asks for.
Rows kernel_rows() {
    Rows rows;
    for (const KernelInfo& kernel : kernels())
        if (!ask_of(kernel.family))
            rows.push_back(kernel_row(kernel));
    for (const AskEntry& entry : asks())
        if (is_kernel_ask(entry.task))
            for (const KernelInfo& kernel : rungs(entry.task))
                rows.push_back(kernel_row(kernel));
    return rows;
}

Rows peer_rows() {
    Rows rows;
    for (const Peer& peer : peers()) {
        Row& row = rows.emplace_back(Row{
            peer.name, fmt::format("{} ({}; {})", peer.summary, peer.version, peer.build), {}, {}});
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
                        "absent: its package was not found when boxwood was built "
                        "(./scripts/setup installs it)",
                        {{"present", "false"}},
                        {}});
    return rows;
}

Rows family_rows() {
    Rows rows;
    for (const HardCaseFamily& family : hard_case_families()) {
        const bool has_k = !family.k_meaning.empty();
        const std::string k = fmt::format(
            "{{\"meaning\":{},\"default\":{},\"least\":{},\"most\":{}}}",
            json_string(family.k_meaning), family.k_default, family.k_least, family.k_most);
        const std::string scale =
            fmt::format("{{\"least\":{},\"most\":{}}}", family.scale_least, family.scale_most);
        Row& row =
            rows.emplace_back(Row{std::string(family.name),
                                  fmt::format("{}: {}", to_string(family.panel), family.summary),
                                  {{"panel", json_string(to_string(family.panel))},
                                   {"k", has_k ? k : "null"},
                                   {"scale", scale},
                                   {"reads_file", family.reads_file ? "true" : "false"}},
                                  {}});
        if (has_k)
            row.notes.push_back(fmt::format("k = {} ({} to {}): {}", family.k_default,
                                            family.k_least, family.k_most, family.k_meaning));
        if (family.scale_least != family.scale_most)
            row.notes.push_back(fmt::format("scale = {} to {} (coordinates times 2^scale)",
                                            family.scale_least, family.scale_most));
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

struct Catalogue {
    std::string_view name, summary;
    Rows (*rows)();
};

constexpr std::array registries{
    Catalogue{"builders", "make the canonical tree from boxes",
              [] { return with_settings(builders()); }},
    Catalogue{"optimizers", "improve a finished tree: BUILDER+OPTIMIZER",
              [] { return with_settings(optimizers()); }},
    Catalogue{"layouts", "the tree in memory, as a traversal likes it", [] { return plain(layouts()); }},
    Catalogue{"updates", "follow boxes that move", [] { return with_settings(updates()); }},
    Catalogue{"traversals", "visit layouts and hand what they find to a sink",
              [] { return plain(traversals()); }},
    Catalogue{"kernels", "decide about one primitive or pair", kernel_rows},
    Catalogue{"scenes", "make the same input on every machine",
              [] { return plain(scene_generators()); }},
    Catalogue{"moving_scenes", "bodies and what happens to them: `boxwood scene`",
              moving_scene_rows},
    Catalogue{"effects", "what may happen to the bodies of a moving scene",
              [] { return with_settings(effects()); }},
    Catalogue{"scene_queries", "what a moving scene may ask of each frame",
              [] { return plain(scene_queries()); }},
    Catalogue{"query_kinds", "how the queries of a moving scene go through it",
              [] { return plain(query_kinds()); }},
    Catalogue{"tasks", "what is wanted of a scene", [] { return plain(asks()); }},
    Catalogue{"executors", "where work runs", [] { return plain(executors()); }},
    Catalogue{"peers", "libraries that are timed and checked beside ours", peer_rows},
    Catalogue{"families", "hard cases for kernels; each is a scene too", family_rows},
};

std::string as_text(const Catalogue& registry, const std::string& indent) {
    const Rows rows = registry.rows();
    std::size_t width = 0;
    for (const Row& row : rows)
        width = std::max(width, row.name.size());
    std::string text;
    for (const Row& row : rows) {
        text += fmt::format("{}{:<{}}  {}\n", indent, row.name, width, row.summary);
        for (const std::string& note : row.notes)
            text += fmt::format("{}{:<{}}    {}\n", indent, "", width, note);
    }
    return text;
}

std::string as_json(const Catalogue& registry) {
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

} // namespace

std::span<const std::string_view> catalogue_names() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> list;
        for (const Catalogue& registry : registries)
            list.push_back(registry.name);
        return list;
    }();
    return names;
}

std::string list_catalogues(std::string_view name, bool json) {
    if (!name.empty()) {
        const auto found = std::ranges::find(registries, name, &Catalogue::name);
        if (found == registries.end())
            throw BadInput(unknown_word("registry", name, catalogue_names()));
        return json ? as_json(*found) + "\n" : as_text(*found, "");
    }
    std::string text;
    for (const Catalogue& registry : registries)
        text += json ? fmt::format("{}{}:{}", text.empty() ? "{" : ",\n ",
                                   json_string(registry.name), as_json(registry))
                     : fmt::format("{}{}: {}\n{}", text.empty() ? "" : "\n", registry.name,
                                   registry.summary, as_text(registry, "  "));
    return json ? text + "}\n" : text;
}

void add_list(CLI::App& app, int&) {
    struct Options {
        std::string registry;
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* list = app.add_subcommand("list", "print the registries: what boxwood is made of");
    list->add_option(
        "registry", options->registry,
        fmt::format("one of {}; all if not given", fmt::join(catalogue_names(), ", ")));
    list->add_flag("--json", options->json,
                   "a list of {\"name\",\"summary\"}; for all registries an object of such lists");
    list->footer("Example: boxwood list builders");
    list->callback([options] { std::cout << list_catalogues(options->registry, options->json); });
}

} // namespace boxwood::bench
