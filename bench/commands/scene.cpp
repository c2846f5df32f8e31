#include "bench/commands/command.h"
#include "bench/commands/option_ranges.h"
#include "bench/io/say.h"
#include "bench/io/scene_picture.h"
#include "bench/io/write_file.h"
#include "scenes/moving/moving_scene.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

constexpr std::size_t max_drawn = 2000; ///< bodies, unless --n says otherwise
constexpr std::uint64_t in_strip = 4;   ///< frames, unless --frame names them

struct SceneOptions {
    std::string scene, svg, strip;
    std::vector<std::uint64_t> frames;
    std::optional<std::size_t> n;
    std::optional<std::uint64_t> seed;
    int depth = -1;
};

std::string effects_text(const BodyGroup& group) {
    std::vector<std::string> texts;
    for (const auto& [name, settings, share] : group.effects) {
        std::vector<std::string> notes;
        if (share != 1)
            notes.push_back(fmt::format("on {:g} %", 100 * share));
        for (const auto& [setting, value] : settings)
            notes.push_back(fmt::format("{} {}", setting, to_text(value)));
        texts.push_back(notes.empty() ? name
                                      : fmt::format("{} ({})", name, fmt::join(notes, ", ")));
    }
    return texts.empty() ? "at rest" : fmt::format("{}", fmt::join(texts, ", "));
}

std::string queries_text(const SceneFile& file) {
    std::vector<std::string> texts;
    for (const SceneQuery& query : file.queries)
        texts.push_back(query.n == 0 ? query.name
                                     : fmt::format("{} ({} {}{})", query.name, query.n, query.kind,
                                                   query.k ? fmt::format(", k {}", query.k) : ""));
    return fmt::format("{}", fmt::join(texts, ", "));
}

std::string group_notes(const BodyGroup& group) {
    std::string text;
    if (group.margin > 0)
        text += fmt::format("; margin {:g}", group.margin);
    if (group.group_ignored)
        text += "; its bodies may overlap each other";
    else if (group.neighbours_ignored)
        text += "; neighbours may overlap";
    return text;
}

void describe(const MovingScene& scene) {
    const SceneFile& file = scene.file();
    fmt::print("{}: {}\n", file.name, file.summary);
    fmt::print("{} bodies, {} meshes, seed {}, {} frames of 1/{:g} s\n", scene.bodies().size(),
               scene.bodies().meshes.size(), file.seed, file.frames, file.frames_per_second);
    for (const BodyGroup& group : file.groups) {
        const std::string size =
            group.n ? fmt::format("{}", group.n) : fmt::format("{:g} % of n", 100 * group.share);
        fmt::print("  {} ({}): {}{}\n", group.generator, size, effects_text(group),
                   group_notes(group));
    }
    fmt::print("  queries: {}\n", queries_text(file));
}

void show_scene(const SceneOptions& options) {
    SceneFile file = load_scene(options.scene);
    if (options.seed)
        file.seed = *options.seed;
    const std::string& svg = options.svg.empty() ? options.strip : options.svg;
    const bool is_drawn = !svg.empty();
    std::optional<std::size_t> n = options.n;
    if (is_drawn && !n && file.n > max_drawn) {
        n = max_drawn;
        say(fmt::format("drawing {} instead of {} bodies; --n {} draws them all\n", max_drawn,
                        file.n, file.n));
    }
    MovingScene scene(std::move(file), n);
    describe(scene);
    std::vector<std::uint64_t> frames = options.frames;
    if (frames.empty() && !options.strip.empty())
        for (std::uint64_t i = 0; i < in_strip; ++i)
            frames.push_back(i * scene.file().frames / (in_strip - 1));
    if (frames.empty())
        frames = {0};
    std::ranges::sort(frames);
    ScenePicture picture(scene, options.depth);
    std::span<const std::uint32_t> changed;
    for (const std::uint64_t frame : frames) {
        while (scene.frame() < frame)
            changed = scene.advance();
        if (is_drawn) {
            picture.add(scene, changed);
            continue;
        }
        const BoxedBodies present = boxed(scene.bodies());
        fmt::print("frame {}: {} present, {} changed, {} pairs\n", frame, present.body.size(),
                   changed.size(), overlapping_bodies(scene, present).size());
    }
    if (!is_drawn)
        return;
    write_file(svg, picture.svg(), "--svg " + svg);
    fmt::print("{}\n", svg);
}

} // namespace

void add_scene(CLI::App& app, int&) {
    CLI::App* scene = app.add_subcommand("scene", "what is in a moving scene, frame by frame");
    const auto options = std::make_shared<SceneOptions>();
    scene->add_option("scene", options->scene, "a built-in scene, or a scene file (.toml)")
        ->required();
    scene->add_option("--frame", options->frames, "frames to show, such as 0,30,60 (default: 0)")
        ->delimiter(',');
    CLI::Option* svg =
        scene->add_option("--svg", options->svg, "draw the frames side by side into this file");
    scene
        ->add_option("--strip", options->strip,
                     "as --svg, but without --frame it draws four frames spread over the scene's")
        ->excludes(svg);
    scene->add_option("--depth", options->depth, "draw the tree's boxes of this depth too")
        ->check(CLI::Range(0, 64));
    scene->add_option("--n", options->n, "number of bodies instead of the scene's")
        ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
    scene->add_option("--seed", options->seed, "the seed instead of the scene's")
        ->check(seed_range());
    scene->footer(
        "The built-in scenes: `boxwood list moving_scenes`; the effects for a scene of your own:\n"
        "`boxwood list effects`.\n"
        "Example: boxwood scene warehouse --n 500 --frame 0,60 --svg warehouse.svg "
        "--depth 3");
    scene->callback([options] { show_scene(*options); });
}

} // namespace boxwood::bench
