#include "bench/commands/plan.h"

#include "bench/commands/command.h"
#include "bench/io/json.h"
#include "bench/stages/scene_player.h"
#include "bench/io/text_table.h"

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
    std::optional<std::size_t> n, play;
    std::optional<std::uint64_t> seed;
    unsigned threads = 1;
    bool everything = false, json = false;
};

std::string plan_json(const MovingScene& scene, Extent extent,
                      const std::vector<PlannedStage>& plan) {
    std::string text = fmt::format("{{\"scene\":{},\"bodies\":{},\"extent\":\"{}\",\"stages\":[",
                                   json_string(scene.file().name), scene.bodies().size(),
                                   extent == Extent::all_stages ? "all_stages" : "required");
    for (const PlannedStage& stage : plan)
        text += fmt::format("{}{{\"stage\":{},\"required\":{},\"runs\":{},\"why\":{}}}",
                            &stage == plan.data() ? "" : ",", json_string(stage.name),
                            stage.is_required, stage.runs, json_string(stage.why));
    return text + "]}\n";
}

void run_plan(const PlanOptions& options) {
    SceneFile file = load_scene(options.scene);
    if (options.n)
        file.n = *options.n;
    if (options.seed)
        file.seed = *options.seed;
    const auto executor = make_executor(options.threads == 1 ? "serial" : "tbb", options.threads);
    const Extent extent = options.everything ? Extent::all_stages : Extent::required;
    if (!options.play)
        fmt::print("{}", plan_text(MovingScene(file), extent, options.json));
    else
        fmt::print("{}", played_text(file, *options.play, *executor));
}

} // namespace

std::string plan_text(const MovingScene& scene, Extent extent, bool json) {
    const std::vector<PlannedStage> plan = plan_stages(scene, extent);
    if (json)
        return plan_json(scene, extent, plan);
    const bool everything = extent == Extent::all_stages;
    std::vector<std::string> headings{"stage", "called for", "why"};
    if (everything)
        headings.insert(headings.begin() + 2, "runs");
    TextTable table(headings);
    std::size_t n_required = 0, n_runs = 0;
    for (const PlannedStage& stage : plan) {
        std::vector<std::string> row{stage.name, stage.is_required ? "yes" : "-", stage.why};
        if (everything)
            row.insert(row.begin() + 2, stage.runs ? "yes" : "-");
        table.add(row);
        n_required += stage.is_required;
        n_runs += stage.runs;
    }
    std::string text = fmt::format("{}: {} of {} stages are called for", scene.file().name,
                                   n_required, plan.size());
    if (everything)
        text += fmt::format("; with everything on {} run, for all bodies in every frame", n_runs);
    return fmt::format("{}\n\n{}", text, table.text());
}

std::string played_text(const SceneFile& file, std::size_t frames, const Executor& executor) {
    ScenePlayer required(MovingScene(file), Extent::required, executor);
    ScenePlayer everything(MovingScene(file), Extent::all_stages, executor);
    const auto in_turns = [&](const auto& play) {
        const bool odd = required.scene().frame() % 2 == 1;
        play(odd ? everything : required);
        play(odd ? required : everything);
        if (answers_hash(required.answers()) != answers_hash(everything.answers()))
            throw std::runtime_error(
                fmt::format("scene {}, frame {}: everything on gives other answers", file.name,
                            required.scene().frame()));
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

    TextTable table({"stage", "called for", ">calls", ">items", ">time", ">share", ">bytes", "",
                     ">everything", ">items", ">share", ">bytes"});
    const Ledger &one = required.ledger(), &all = everything.ledger();
    const auto share = [](double ns, const Ledger& of) {
        return fmt::format("{:.1f} %", of.total_ns() > 0 ? 100 * ns / of.total_ns() : 0);
    };
    for (std::size_t i = 0; i < one.rows().size(); ++i) {
        const LedgerRow &a = one.rows()[i], &b = all.rows()[i];
        if (a.calls == 0 && b.calls == 0)
            continue;
        table.add({a.stage, a.is_required ? "yes" : "-", fmt::format("{}", a.calls),
                   fmt::format("{}", a.items), a.calls ? time_text(a.ns) : "-",
                   a.calls ? share(a.ns, one) : "-", fmt::format("{}", a.bytes), "",
                   b.calls ? time_text(b.ns) : "-", fmt::format("{}", b.items),
                   b.calls ? share(b.ns, all) : "-", fmt::format("{}", b.bytes)});
    }
    table.add({"all", "", "", "", time_text(one.total_ns()), "", "", "", time_text(all.total_ns()),
               "", "", ""});
    return fmt::format("{}, {} bodies, {} frames and the start: the same answers\n\n{}\n"
                       "everything on takes {} times as long\n",
                       file.name, required.scene().bodies().size(), frames, table.text(),
                       ratio_text(all.total_ns() / one.total_ns()));
}

void add_plan(CLI::App& app, int&) {
    CLI::App* plan =
        app.add_subcommand("plan", "which stages a moving scene calls for, and why the others not");
    const auto options = std::make_shared<PlanOptions>();
    plan->add_option("scene", options->scene, "a built-in scene, or a scene file (.toml)")
        ->required();
    plan->add_option("--n", options->n, "number of bodies instead of the scene's")
        ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
    plan->add_option("--seed", options->seed, "instead of the scene's");
    plan->add_flag("--everything", options->everything,
                   "the plan with everything on: what runs though nobody calls for it");
    CLI::Option* json = plan->add_flag("--json", options->json, "print one JSON object");
    plan->add_option("--play", options->play,
                     "play so many frames both ways and print what each stage did")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000}))
        ->excludes(json);
    plan->add_option("--threads", options->threads, "for --play; more than one run on tbb")
        ->check(CLI::Range(1u, 1024u));
    plan->footer(
        "The built-in scenes: `boxwood list moving_scenes`; what a scene may ask: `boxwood "
        "list scene_queries`.\n"
        "Example: boxwood plan warehouse --play 20");
    plan->callback([options] { run_plan(*options); });
}

} // namespace boxwood::bench
