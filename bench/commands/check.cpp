#include "bench/running/check.h"

#include "bench/analysis/analyse.h"
#include "bench/analysis/kernel_costs.h"
#include "bench/analysis/promises.h"
#include "bench/commands/command.h"
#include "bench/commands/option_ranges.h"
#include "bench/machine/environment.h"
#include "bench/truth/judging/case_truths.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <iostream>
#include <memory>

namespace boxwood::bench {
namespace {

Scene checked_scene(SceneSpec spec, const CheckOptions& options) {
    Scene scene = make_scene(spec);
    if (options.one) {
        const std::size_t n = n_cases(scene.cases);
        if (*options.one >= n)
            throw BadInput(fmt::format("--case {}: {} has {} cases, numbered from 0", *options.one,
                                       scene.name, n));
        scene.cases = only_case(scene.cases, *options.one);
    }
    return scene;
}

int run(const CheckOptions& options, const std::filesystem::path& out) {
    const std::vector<SceneSpec> specs = check_scenes(options);
    if (options.one && specs.size() > 1)
        throw BadInput("--case needs one family and one scale: name them with --only and --scale");
    results::Env env = environment(false);
    env.seed = options.seed;
    CheckRun check(options, env);

    Progress progress(stderr);
    Eta eta(static_cast<double>(specs.size()));
    const auto start = std::chrono::steady_clock::now();
    for (const SceneSpec& spec : specs) {
        const Scene scene = checked_scene(spec, options);
        check.judge(scene, [&](const Task& task) {
            const double elapsed =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            progress.show({"checking", eta.fraction(), eta.left_s(elapsed),
                           fmt::format("{}/{}", scene.name, task.name())});
        });
        eta.done(1);
    }
    progress.show({"checking", 1, 0, ""});
    results::Results results = check.results();
    analyse(results);
    if (!out.empty())
        results::write(out, results);
    fmt::print("{}{}\n{}", check.details(), kernel_costs_text(results), promises_text(results));
    if (!out.empty())
        fmt::print("results: {}\n", out.string());
    return broken_promises(results) > 0 ? exit_failed : exit_success;
}

} // namespace

void add_check(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<CheckOptions>();
    auto out = std::make_shared<std::filesystem::path>();
    auto n = std::make_shared<std::optional<std::size_t>>();
    CLI::App* check = app.add_subcommand(
        "check", "test the kernels, ours and the peers', against the truth on hard cases");
    check->add_option("--only", options->only,
                      "only what this regular expression is found in: family/task/kernel");
    check->add_option("--out", *out, "a result file to write (HDF5), for scripts/plot");
    check->add_option("--n", *n, "cases of each family (1000; with --quick 300)")
        ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
    check->add_option("--seed", options->seed, "key of the random numbers")->check(seed_range());
    check->add_option("--k", options->k, "the families' own parameter (`boxwood list families`)");
    check->add_option(
        "--scale", options->scale,
        "multiply every coordinate by 2^SCALE; if not given, 0 and both ends of the range");
    check->add_option("--case", options->one,
                      "only the case of this number: print it, the truth and each answer");
    check->add_flag("--quick", options->is_quick,
                    "fewer cases, fewest at the extreme scales: about a minute and a half");
    check->add_option("--ccd", options->ccd,
                      "a folder of query files for the families that read files, such as data/ccd");
    check->footer(
        "A promise is what a kernel states in `boxwood list kernels`: never-leaks (rays from\n"
        "inside closed meshes hit, in trees of every layout too), never-miss (no false no),\n"
        "never-false (no false yes), certified (sure answers and bounds hold), exact (of rays t,\n"
        "u, v and the triangle too). In trees of every layout the nearest hit of a ray is that of\n"
        "its kernel without a tree, the lowest of several triangles; all hits are those of the\n"
        "kernel, each once, by t. Each family is judged at its default k; the truth comes by "
        "construction\n"
        "or from rational arithmetic.\n"
        "A broken promise is printed with its case in hex floats and the command that replays it.\n"
        "Peers and kernels without a promise are judged on the same cases, and may err.\n\n"
        "Examples:\n"
        "  boxwood check --quick\n"
        "  boxwood check --only triangle_distance --out check.h5\n"
        "  boxwood check --only '^slivers/triangle_triangle/' --k 6 --scale 40 --case 17\n"
        "Exit codes: 0 every promise is kept, 1 one of ours is broken, 2 bad input.");
    check->callback([=, &exit_code] {
        options->n = n->value_or(options->is_quick ? 300 : 1000);
        exit_code = run(*options, *out);
    });
}

} // namespace boxwood::bench
