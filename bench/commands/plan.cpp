#include "bench/commands/plan.h"

#include "bench/commands/command.h"
#include "bench/commands/devices.h"
#include "bench/commands/option_ranges.h"
#include "bench/io/bad_input.h"
#include "bench/io/json.h"
#include "bench/io/text_table.h"
#include "bench/stages/scene_player.h"
#include "bench/stages/stages_contender.h"
#include "trees/device.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

struct PlanOptions {
    std::string scene;
    std::optional<std::string> device;
    std::optional<std::size_t> n, play;
    std::optional<std::uint64_t> seed;
    unsigned threads = 1;
    bool all_stages = false, json = false;
};

std::string plan_json(const MovingScene& scene, Extent extent,
                      const std::vector<PlannedStage>& plan) {
    std::string text =
        fmt::format("{{\"scene\":{},\"bodies\":{},\"extent\":\"{}\",\"stages\":[",
                    json_string(scene.file().name), scene.bodies().size(),
                    extent == Extent::all_stages ? all_stages_variant : required_variant);
    for (const PlannedStage& stage : plan)
        text += fmt::format(
            "{}{{\"stage\":{},\"required\":{},\"runs\":{},\"on_device\":{},\"why\":{}}}",
            &stage == plan.data() ? "" : ",", json_string(stage.name), stage.is_required,
            stage.runs, stage.on_device, json_string(stage.why));
    return text + "]}\n";
}

void run_plan(const PlanOptions& options) {
    SceneFile file = load_scene(options.scene);
    if (options.n)
        file.n = *options.n;
    if (options.seed)
        file.seed = *options.seed;
    const auto executor = make_executor(default_executor(options.threads), options.threads);
    const Extent extent = options.all_stages ? Extent::all_stages : Extent::required;
    DevicePlace place;
    Where where = Where::host;
    if (options.device) {
        place.index = chosen_device(*options.device, devices(), why_no_device());
        where = where_on_device(MovingScene(file));
    }
    if (!options.play)
        fmt::print("{}", plan_text(MovingScene(file), extent, options.json, where));
    else
        fmt::print("{}", played_text(file, *options.play, *executor, where, place));
}

/// How the bodies of a scene and a device meet.
std::string device_text(const MovingScene& scene, Where where) {
    if (where == Where::resident)
        return "on the device: the bodies stay there, and pairs come down in each frame";
    return fmt::format("on the device: boxes go up and pairs come down in each frame, as {}",
                       *why_not(scene, Extent::required, Where::resident));
}

} // namespace

Where where_on_device(const MovingScene& scene) {
    for (const Where where : {Where::resident, Where::device})
        if (!why_not(scene, Extent::required, where))
            return where;
    throw BadInput(fmt::format("scene {}: {}; without --device it is played on the host",
                               scene.file().name,
                               *why_not(scene, Extent::required, Where::device)));
}

std::string plan_text(const MovingScene& scene, Extent extent, bool json, Where where) {
    const std::vector<PlannedStage> plan = plan_stages(scene, extent, where);
    if (json)
        return plan_json(scene, extent, plan);
    const bool is_all = extent == Extent::all_stages;
    std::vector<std::string> headings{"stage", "required", "why"};
    if (is_all)
        headings.insert(headings.begin() + 2, "runs");
    if (where != Where::host)
        headings.insert(headings.begin() + 2, "on");
    TextTable table(headings);
    std::size_t n_required = 0, n_runs = 0;
    for (const PlannedStage& stage : plan) {
        std::vector<std::string> row{stage.name, stage.is_required ? "yes" : "-", stage.why};
        if (is_all)
            row.insert(row.begin() + 2, stage.runs ? "yes" : "-");
        if (where != Where::host)
            row.insert(row.begin() + 2, stage.on_device ? "device" : stage.runs ? "host" : "-");
        table.add(row);
        n_required += stage.is_required;
        n_runs += stage.runs;
    }
    std::string text = fmt::format("{}: the scene requires {} of {} stages", scene.file().name,
                                   n_required, plan.size());
    if (is_all)
        text += fmt::format("; with all stages {} run, for all bodies in every frame", n_runs);
    if (where != Where::host)
        text += '\n' + device_text(scene, where);
    return fmt::format("{}\n\n{}", text, table.text());
}

std::string played_text(const SceneFile& file, std::size_t frames, const Executor& executor,
                        Where where, DevicePlace place) {
    const bool on_device = where != Where::host;
    const std::string_view others = on_device ? "on device" : "all stages";
    ScenePlayer required(MovingScene(file), Extent::required, executor);
    ScenePlayer other(MovingScene(file), on_device ? Extent::required : Extent::all_stages,
                      executor, where, place);
    const auto in_turns = [&](const auto& play) {
        const bool odd = required.scene().frame() % 2 == 1;
        play(odd ? other : required);
        play(odd ? required : other);
        if (answers_hash(required.answers()) != answers_hash(other.answers()))
            throw std::runtime_error(fmt::format("scene {}, frame {}: other answers {}", file.name,
                                                 required.scene().frame(),
                                                 on_device ? "on the device" : "with all stages"));
    };
    in_turns([](ScenePlayer& player) {
        player.start();
        player.query();
    });
    for (std::size_t frame = 0; frame < frames; ++frame)
        in_turns([](ScenePlayer& player) {
            player.advance();
            player.query();
        });

    TextTable table({"stage", "required", ">calls", ">items", ">time", ">share", ">bytes", "",
                     fmt::format(">{}", others), ">items", ">share", ">bytes"});
    const Ledger &one = required.ledger(), &all = other.ledger();
    const auto share = [](double ns, const Ledger& of) {
        return fmt::format("{:.1f} %", of.total_ns() > 0 ? 100 * ns / of.total_ns() : 0);
    };
    for (const LedgerRow& b : all.rows()) {
        const LedgerRow a = b.is_crossing() ? LedgerRow{.stage = b.stage} : one.row(b.stage);
        if (a.calls == 0 && b.calls == 0)
            continue;
        table.add({a.stage, b.is_required ? "yes" : "-", fmt::format("{}", a.calls),
                   fmt::format("{}", a.items), a.calls ? time_text(a.ns) : "-",
                   a.calls ? share(a.ns, one) : "-", fmt::format("{}", a.bytes), "",
                   b.calls ? time_text(b.ns) : "-", fmt::format("{}", b.items),
                   b.calls ? share(b.ns, all) : "-", fmt::format("{}", b.bytes)});
    }
    table.add({"all", "", "", "", time_text(one.total_ns()), "", "", "", time_text(all.total_ns()),
               "", "", ""});
    return fmt::format("{}, {} bodies, {} frames and the start: the same answers\n\n{}\n"
                       "{} it takes {} times as long, in this one play (a sweep of the task "
                       "scene_queries gives intervals)\n",
                       file.name, required.scene().bodies().size(), frames, table.text(),
                       on_device ? device_text(required.scene(), where) + ";\nthere"
                                 : "with all stages",
                       ratio_text(all.total_ns() / one.total_ns()));
}

void add_plan(CLI::App& app, int&) {
    CLI::App* plan = app.add_subcommand(
        "plan", "which stages a moving scene requires, and why it does not require the others");
    const auto options = std::make_shared<PlanOptions>();
    plan->add_option("scene", options->scene, "a built-in scene, or a scene file (.toml)")
        ->required();
    plan->add_option("--n", options->n, "number of bodies instead of the scene's")
        ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
    plan->add_option("--seed", options->seed, "the seed instead of the scene's")
        ->check(seed_range());
    CLI::Option* all_stages = plan->add_flag(
        "--all-stages", options->all_stages,
        "the plan with all stages: those that run though the scene does not require them");
    plan->add_option("--device", options->device,
                     "a name of `boxwood list devices`: the plan on that GPU, and what crosses to "
                     "it; --play plays it beside the same on the host")
        ->excludes(all_stages);
    CLI::Option* json = plan->add_flag("--json", options->json, "print one JSON object");
    plan->add_option(
            "--play", options->play,
            "play so many frames, with the required stages and with all, and print what each did")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000}))
        ->excludes(json);
    plan->add_option("--threads", options->threads, "threads for --play; more than one run on tbb")
        ->check(CLI::Range(1u, 1024u));
    plan->footer(
        "The built-in scenes: `boxwood list moving_scenes`; what a scene may want of each frame:\n"
        "`boxwood list scene_queries`.\n\n"
        "Examples:\n"
        "  boxwood plan warehouse               the stages, and why each is there or not\n"
        "  boxwood plan warehouse --play 20     calls, time and memory of each, over 20 frames");
    plan->callback([options] { run_plan(*options); });
}

} // namespace boxwood::bench
