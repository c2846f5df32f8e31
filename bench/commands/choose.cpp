#include "bench/advice/advice.h"
#include "bench/advice/candidates.h"
#include "bench/advice/policies.h"
#include "bench/commands/command.h"
#include "bench/commands/option_ranges.h"
#include "bench/io/read_results.h"
#include "bench/io/say.h"
#include "bench/io/write_file.h"
#include "bench/running/sweep.h"
#include "kernels/suggest.h"
#include "scenes/moving/recording.h"
#include "scenes/moving/scene_file.h"
#include "trees/builder.h"
#include "trees/dynamic/update.h"
#include "trees/layout.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

/// What is asked, and how a sweep file says it.
struct Question {
    std::string_view name, summary, block; ///< the keys of the block but scene, builders, layouts
    Query query;
    std::string_view layout; ///< that builders are tried in
    std::string_view peers;
};
constexpr Question questions[] = {
    {"rays", "the nearest hit of random rays, one after another",
     "task = \"rays_closest\"\nrays = \"random\"\nn_rays = 20000\nray_order = \"single\"\n"
     "kernels = \"watertight\"\n",
     Query::rays, "wide8",
     "\"embree.rtc_intersect1.robust.low\", \"embree.rtc_intersect1.robust\", "
     "\"embree.rtc_intersect1.robust.high\""},
    {"pairs", "which boxes overlap", "task = \"pairs\"\n", Query::self_pairs, "packed",
     "\"fcl.dynamic_aabb_tree_f32\", \"embree.rtc_collide.low\", \"embree.rtc_collide.medium\", "
     "\"cgal\", \"bullet.dbvt\""},
    {"points", "which boxes contain a point", "task = \"points\"\nn_points = 20000\n",
     Query::points, "wide8", "\"all\""},
    {"nearest", "the nearest box to a point", "task = \"nearest\"\nn_points = 20000\n",
     Query::nearest, "wide8", "\"all\""},
};

const Question& question_named(const std::string& name) {
    for (const Question& question : questions)
        if (question.name == name)
            return question;
    std::vector<std::string_view> names;
    for (const Question& question : questions)
        names.push_back(question.name);
    names.push_back("moving");
    throw BadInput("choose: --task: " + unknown_name("question", name, names));
}

struct ChooseOptions {
    fs::path mesh, boxes, motion, out;
    std::string scene;
    std::string task;
    double minutes = 2;
    std::optional<double> queries;
    unsigned threads = 1;
    bool as_json = false;
};

std::string quoted_list(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "" : ", ") + ('"' + name + '"');
    return '[' + text + ']';
}

/// Every builder, and the best of them with what improves their trees.
std::vector<std::string> builders_to_try() {
    std::vector<std::string> all;
    for (const BuilderEntry& builder : builders())
        if (builder.name != "incremental") // one box at a time: for DynamicBvh
            all.emplace_back(builder.name);
    for (const OptimizerEntry& optimizer : optimizers())
        for (const char* builder : {"hilbert", "ploc", "binned_sah"})
            all.push_back(fmt::format("{}+{}", builder, optimizer.name));
    return all;
}

/// As result files record it.
constexpr std::string_view choose_command_line = "boxwood choose";

/// A sweep of blocks that are written for it.
class OwnSweep {
  public:
    explicit OwnSweep(const ChooseOptions& options) : options_(options) {
        try {
            folder_ = fs::temp_directory_path() / fmt::format("boxwood-choose-{}", getpid());
            fs::create_directories(folder_);
        } catch (const fs::filesystem_error& error) {
            throw BadInput(fmt::format(
                "choose: no folder for temporary files: {}; TMPDIR names one", error.what()));
        }
    }
    ~OwnSweep() {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    OwnSweep(const OwnSweep&) = delete;

    const fs::path& folder() const { return folder_; }
    /// Gives an exit code, 0 if it was measured. Without a budget three rounds are run.
    int run(const std::string& blocks, const fs::path& out, double budget_s) const {
        const fs::path config = folder_ / "choose.toml";
        std::ofstream(config) << fmt::format("rounds = {}\nmin_time_ms = 5\nthreads = {}\n\n{}",
                                             budget_s > 0 ? 9 : 3, options_.threads, blocks);
        SweepOptions sweep;
        sweep.config = config;
        sweep.out = out;
        sweep.budget_s = budget_s;
        sweep.wait_s = 10;
        sweep.is_quiet = true;
        sweep.goes_on = false;
        sweep.command_line = choose_command_line;
        if (!options_.mesh.empty())
            sweep.overrides.meshes = {options_.mesh};
        if (!options_.boxes.empty())
            sweep.overrides.boxes = {options_.boxes};
        if (!options_.motion.empty())
            sweep.overrides.motions = {options_.motion};
        return run_sweep(sweep);
    }

  private:
    const ChooseOptions& options_;
    fs::path folder_;
};

class Chooser {
  public:
    explicit Chooser(const ChooseOptions& options)
        : options_(options), question_(question_named(options.task)), sweep_(options) {}

    int run() {
        const auto start = std::chrono::steady_clock::now();
        say(fmt::format("trying {} builders and {} layouts\n", builders_to_try().size(),
                        layouts_to_try().size()));
        const std::string first = std::string(question_.layout);
        const fs::path once = sweep_.folder() / "first.h5";
        std::string blocks = block(builders_to_try(), {first}, false) +
                             block({tried_builder}, layouts_to_try(), false);
        const bool has_fused = tries_fused();
        if (has_fused) // all but the builder that is tried in every layout
            blocks += block(without(builders_to_try(), {tried_builder}), {fused_layout}, false);
        if (const int code = sweep_.run(blocks, once, 0))
            return code;
        const Advice tried = advise(read_results(once));
        auto [builders, layouts] = candidates_of(tried, question_.layout, tried_builder);
        if (builders.empty())
            builders = {tried_builder};
        if (layouts.empty())
            layouts = {first};
        blocks = block(builders, layouts, true);
        std::vector<std::string> fused;
        if (has_fused) {
            fused = candidates_of(tried, fused_layout, tried_builder).builders;
            if (std::ranges::find(layouts, fused_layout) != layouts.end())
                fused = without(std::move(fused), builders);
            if (!fused.empty())
                blocks += block(fused, {fused_layout}, false);
        }
        const double spent =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        say(fmt::format(
            "timing {} x {}, {}and the peers\n", fmt::join(builders, ", "),
            fmt::join(layouts, ", "),
            fused.empty() ? "" : fmt::format("{} x {}, ", fmt::join(fused, ", "), fused_layout)));
        const fs::path picture = fs::path(options_.out).replace_extension(".svg");
        fs::remove(options_.out); // what was timed before is not asked again
        fs::remove(picture);
        if (const int code =
                sweep_.run(blocks, options_.out, std::max(10., 60 * options_.minutes - spent)))
            return code;
        const Advice advice = advise(read_results(options_.out), options_.queries);
        write_file(picture, advice_picture(advice), "choose: the picture " + picture.string());
        std::cout << (options_.as_json ? advice_json(advice) : advice_text(advice));
        if (!options_.as_json)
            std::cout << fmt::format("\nevidence  {}\npicture   {}\n", options_.out.string(),
                                     picture.string());
        return 0;
    }

  private:
    static constexpr const char* tried_builder = "binned_sah"; ///< that layouts are tried under
    /// Some builders make this one straight from their order, at a fraction of the time of others:
    /// how they do in another layout says nothing of it.
    static constexpr const char* fused_layout = "packed";

    bool tries_fused() const {
        const std::vector<std::string> all = layouts_to_try();
        return question_.layout != fused_layout &&
               std::ranges::find(all, fused_layout) != all.end();
    }
    static std::vector<std::string> without(std::vector<std::string> names,
                                            const std::vector<std::string>& others) {
        std::erase_if(names, [&](const std::string& name) {
            return std::ranges::find(others, name) != others.end();
        });
        return names;
    }

    std::vector<std::string> layouts_to_try() const {
        std::vector<std::string> all;
        for (const LayoutEntry& layout : layouts())
            if (layout.answers(question_.query) && layout.precision == "f32")
                all.emplace_back(layout.name);
        return all;
    }

    std::string block(const std::vector<std::string>& builders,
                      const std::vector<std::string>& layouts, bool with_peers) const {
        return fmt::format("[[cells]]\nscene = \"{}\"\n{}builders = {}\nlayouts = {}\n{}\n",
                           options_.mesh.empty() ? "boxes" : "mesh", question_.block,
                           quoted_list(builders), quoted_list(layouts),
                           with_peers ? fmt::format("peers = [{}]\n", question_.peers) : "");
    }

    const ChooseOptions& options_;
    const Question& question_;
    OwnSweep sweep_;
};

/// Before what was timed earlier is removed.
void require_motion(const ChooseOptions& options) {
    try {
        if (options.motion.empty())
            load_scene(options.scene);
        else
            read_recording(options.motion);
    } catch (const std::exception& error) {
        throw BadInput(fmt::format("choose: {}", error.what()));
    }
}

/// Every update policy, and the peers that take frames.
int choose_policy(const ChooseOptions& options) {
    require_motion(options);
    std::vector<std::string> policies;
    for (const UpdateEntry& update : updates())
        policies.emplace_back(update.name);
    say(fmt::format("timing {}, and the peers\n", fmt::join(policies, ", ")));
    const OwnSweep sweep(options);
    const std::string scene = options.motion.empty() ? (options.scene.ends_with(".toml")
                                                            ? fs::absolute(options.scene).string()
                                                            : options.scene)
                                                     : std::string(motion_scene);
    fs::remove(options.out);
    if (const int code = sweep.run(
            fmt::format(
                "[[cells]]\nscene = \"{}\"\ntask = \"moving_pairs\"\nupdates = {}\n"
                "peers = [\"fcl.dynamic_aabb_tree_f32.moved\", \"fcl.dynamic_aabb_tree_f32\", "
                "\"bullet.dbvt\", \"embree.rtc_collide.low\"]\n",
                scene, quoted_list(policies)),
            options.out, 60 * options.minutes))
        return code;
    const PolicyAdvice advice = advise_of_policies(read_results(options.out));
    std::cout << (options.as_json ? policies_json(advice)
                                  : policies_text(advice) +
                                        fmt::format("\nevidence  {}\n", options.out.string()));
    return 0;
}

/// What was measured before is measured again; but nobody else's file is lost.
void require_own(const fs::path& out, bool is_drawn) {
    const fs::path picture = fs::path(out).replace_extension(".svg");
    if (is_drawn && !fs::exists(out) && fs::exists(picture))
        throw BadInput(fmt::format("choose: the picture would go to '{}', which is there and not "
                                   "from here; name another file by --out, or remove it",
                                   picture.string()));
    if (!fs::exists(out))
        return;
    const results::Results there = read_results(out);
    const auto argv = there.texts.find("argv");
    if (argv == there.texts.end() || argv->second != choose_command_line)
        throw BadInput(fmt::format("choose: --out '{}' holds what another command measured; name "
                                   "another file, or remove it",
                                   out.string()));
}

/// Before time is spent.
void require_writable(const fs::path& file) {
    const bool was_there = fs::exists(fs::symlink_status(file)); // a link that leads nowhere stays
    const bool is_open = std::ofstream(file, std::ios::app).is_open();
    if (!was_there)
        fs::remove(file);
    if (!is_open)
        throw BadInput(fmt::format("choose: '{}' cannot be written", file.string()));
}

int choose(ChooseOptions options) {
    const bool moves = !options.scene.empty() || !options.motion.empty();
    if (!options.mesh.empty() + !options.boxes.empty() + !options.scene.empty() +
            !options.motion.empty() !=
        1)
        throw BadInput(
            "choose: name what it is for: one of --mesh FILE, --boxes FILE, --motion FILE "
            "and --scene NAME");
    if (options.task.empty())
        options.task = moves ? "moving" : options.mesh.empty() ? "pairs" : "rays";
    if (moves != (options.task == "moving"))
        throw BadInput(
            "choose: --task moving is for --scene and --motion, and these for nothing else");
    if (options.mesh.empty() && options.task == "rays")
        throw BadInput("choose: rays meet triangles; give --mesh FILE");
    if (!std::isfinite(options.minutes))
        throw BadInput("choose: --minutes: a number is wanted");
    if (options.queries && !(*options.queries > 0 && std::isfinite(*options.queries)))
        throw BadInput(
            fmt::format("choose: --queries {}: a number above 0 is wanted, of queries that "
                        "you make of one tree",
                        *options.queries));
    if (options.out.empty()) {
        fs::path of = options.scene;
        for (const fs::path& file : {options.mesh, options.boxes, options.motion})
            if (!file.empty())
                of = file;
        options.out = fmt::format("choose-{}-{}.h5", of.stem().string(), options.task);
    }
    if (options.out.extension() != ".h5")
        throw BadInput(fmt::format("choose: --out '{}': the name of a result file ends in .h5",
                                   options.out.string()));
    if (const fs::path folder = fs::absolute(options.out).parent_path(); !fs::is_directory(folder))
        throw BadInput(
            fmt::format("choose: --out '{}': there is no folder {}; make it: mkdir -p {}",
                        options.out.string(), folder.string(), folder.string()));
    require_own(options.out, !moves);
    require_writable(options.out);
    if (!moves)
        require_writable(fs::path(options.out).replace_extension(".svg"));
    return moves ? choose_policy(options) : Chooser(options).run();
}

} // namespace

void add_choose(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ChooseOptions>();
    CLI::App* command = app.add_subcommand(
        "choose", "which builder and layout, or update policy, to take for what you have");
    command->add_option("--mesh", options->mesh, "a mesh (OBJ, PLY, STL, ...)");
    command->add_option("--boxes", options->boxes,
                        "boxes (CSV, min_x,min_y,min_z,max_x,max_y,max_z a line)");
    command->add_option(
        "--motion", options->motion,
        "boxes that move (CSV, frame,body,min_x,min_y,min_z,max_x,max_y,max_z a line)");
    command->add_option("--scene", options->scene,
                        "a moving scene of boxwood list moving_scenes, or a scene file (.toml)");
    std::string tasks;
    for (const Question& question : questions)
        tasks +=
            fmt::format("{}{} ({})", tasks.empty() ? "" : ", ", question.name, question.summary);
    command->add_option("--task", options->task,
                        tasks + ", moving (the pairs of each frame); by what is given if not said");
    command->add_option("--minutes", options->minutes, "how long it may take, about")
        ->check(number_range(0.2, 600))
        ->capture_default_str();
    command->add_option("--queries", options->queries,
                        "how many queries (rays, ...) you make of one tree before you build it "
                        "again; else as many as are timed, 20000, of pairs one");
    command->add_option("--threads", options->threads, "of build and query")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    command->add_option("--out", options->out,
                        "the result file with the evidence; a picture (.svg) goes beside it");
    command->add_flag("--json", options->as_json, "as one JSON object");
    command->footer(
        "Example: boxwood choose --mesh scenes/examples/ball.obj --queries 50000 --minutes 0.2\n"
        "Each builder and layout is tried in three rounds; those that may be best for some number "
        "of queries\nare timed in rounds that take turns, until the time is spent.\n"
        "Exit codes: 0 done, 1 an answer was wrong, 2 bad input, 130 interrupted.");
    command->callback([options, &exit_code] { exit_code = choose(*options); });
}

} // namespace boxwood::bench
