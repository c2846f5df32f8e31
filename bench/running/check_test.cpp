/// Checks of kernels that lie, and the command as a whole.

#include "bench/running/check.h"

#include "bench/analysis/analyse.h"
#include "bench/analysis/promises.h"
#include "bench/io/bad_input.h"
#include "bench/plan/families.h"
#include "bench/tasks/all_hits.h"
#include "bench/tasks/task.h"
#include "bench/truth/judging/case_truths.h"
#include "kernels/triangle_distance/distance_kernel.h"
#include "trees/queries/sinks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Scene touching_triangles() {
    SceneSpec spec;
    spec.generator = families_of("touching", *find_task("triangle_triangle")).front()->name;
    spec.n = 40;
    return make_scene(spec);
}

/// Runs `answer` and calls it a kernel.
class MadeUp final : public Contender {
  public:
    using Answer = std::function<void(const Scene&, Answers&)>;
    MadeUp(const Scene& scene, Answer answer) : scene_(scene), answer_(std::move(answer)) {}
    void build() override {}
    void query(Answers& answers) override { answer_(scene_, answers); }

  private:
    const Scene& scene_;
    Answer answer_;
};

/// Of any task.
ContenderEntry made_up(Promise promise, MadeUp::Answer answer, bool is_peer = false) {
    ContenderEntry entry;
    entry.name = "made_up";
    entry.library = is_peer ? "rogue" : "boxwood";
    entry.precision = "f64";
    entry.is_peer = is_peer;
    entry.promise = promise;
    for (const Task* task : tasks())
        entry.answers.push_back({std::string(task->name()), [answer](const Job& job) {
                                     return std::make_unique<MadeUp>(*job.scene, answer);
                                 }});
    return entry;
}

/// The result of a check in which `contender` alone does the task.
results::Results checked(const Scene& scene, std::string_view task,
                         const ContenderEntry& contender) {
    const CheckOptions options;
    CheckRun run(options, results::Env{}, [&](const Task& wanted) {
        return wanted.name() == task ? std::vector{contender} : std::vector<ContenderEntry>{};
    });
    run.judge(scene, [](const Task&) {});
    results::Results results = run.results();
    analyse(results);
    return results;
}

/// All answers the same.
MadeUp::Answer always(Answer answer) {
    return [answer](const Scene& scene, Answers& answers) {
        list_of<Decision>(answers).assign(n_cases(scene.cases), {answer, 0});
    };
}

TEST(Check, AKernelThatMissesBreaksItsPromiseToNeverMiss) {
    const Scene scene = touching_triangles();
    const results::Results lie =
        checked(scene, "triangle_triangle", made_up(Promise::never_miss, always(Answer::no)));
    ASSERT_EQ(lie.kernels.size(), 1u);
    EXPECT_GT(lie.kernels[0].false_neg, 0u);
    EXPECT_EQ(broken_promises(lie), 1u);
    EXPECT_TRUE(is_promise_broken(lie));
    EXPECT_THAT(promises_text(lie), AllOf(HasSubstr("BROKEN PROMISE: made_up promises never-miss"),
                                          HasSubstr("said no, truth yes"), HasSubstr("--case "),
                                          HasSubstr("1 broken promise.")));
    EXPECT_EQ(lie.kernels[0].is_broken, 1u);

    const results::Results safe =
        checked(scene, "triangle_triangle", made_up(Promise::never_miss, always(Answer::yes)));
    EXPECT_EQ(broken_promises(safe), 0u);
    EXPECT_FALSE(is_promise_broken(safe));
    EXPECT_EQ(promises_text(safe), "Every promise is kept.\n");
}

TEST(Check, EveryLieOfEveryPromiseIsFound) {
    const Scene scene = touching_triangles();
    const auto is_broken = [&](Promise promise, Answer answer) {
        return broken_promises(
                   checked(scene, "triangle_triangle", made_up(promise, always(answer)))) > 0;
    };
    EXPECT_TRUE(is_broken(Promise::exact, Answer::maybe));
    EXPECT_TRUE(is_broken(Promise::certified, Answer::no));
    EXPECT_FALSE(is_broken(Promise::certified, Answer::maybe));
    EXPECT_FALSE(is_broken(Promise::never_false, Answer::no));
    EXPECT_FALSE(is_broken(Promise::none, Answer::no)); // wrong, but nothing was promised
}

TEST(Check, ACertificateThatDoesNotEncloseIsAViolation) {
    const Scene scene = touching_triangles();
    const Task& task = *find_task("triangle_distance");
    const ContenderEntry truth = task.kernel_contender("rational");
    const auto shifted = [&](double ratio) {
        return made_up(Promise::certified, [&, ratio](const Scene& s, Answers& answers) {
            truth.make(Job{&s, &task})->query(answers);
            list_of<Distance>(answers).back().lo = 1e300 * ratio; // above every distance
        });
    };
    EXPECT_EQ(broken_promises(checked(scene, "triangle_distance", shifted(0))), 0u);
    const results::Results lie = checked(scene, "triangle_distance", shifted(1));
    EXPECT_EQ(broken_promises(lie), 1u);
    EXPECT_EQ(lie.kernels[0].bound_violations, 1u);
    EXPECT_THAT(lie.kernels[0].witness, HasSubstr("case 39: said"));
}

TEST(Check, PeersMayErrAndCrashAndHaveNoPromise) {
    const Scene scene = touching_triangles();
    const results::Results wrong =
        checked(scene, "triangle_triangle", made_up(Promise::none, always(Answer::no), true));
    EXPECT_EQ(wrong.kernels[0].status, results::Status::wrong);
    EXPECT_FALSE(is_promise_broken(wrong));
    const results::Results crash =
        checked(scene, "triangle_triangle",
                made_up(
                    Promise::none, [](const Scene&, Answers&) { raise(SIGKILL); }, true));
    EXPECT_EQ(crash.kernels[0].status, results::Status::wrong);
    EXPECT_THAT(crash.checks[0].witness, HasSubstr("crashed: signal 9"));
    EXPECT_EQ(broken_promises(crash), 0u);
}

TEST(Check, AThrowBreaksAPromise) {
    const results::Results thrown = checked(
        touching_triangles(), "triangle_triangle",
        made_up(Promise::exact, [](const Scene&, Answers&) { throw std::logic_error("oh"); }));
    EXPECT_EQ(broken_promises(thrown), 1u);
    EXPECT_THAT(promises_text(thrown), HasSubstr("oh"));
}

TEST(Check, WhoRefusesGoodBoxesBreaksAPromise) {
    SceneSpec spec;
    spec.generator = "nested_boxes";
    spec.n = 20;
    const Scene scene = make_scene(spec);
    const results::Results refused =
        checked(scene, "pairs", made_up(Promise::exact, [](const Scene& of, Answers&) {
                    Box bad = of.boxes[3];
                    bad.min.x = bad.max.x + 1;
                    require_valid(bad, 3);
                }));
    EXPECT_EQ(broken_promises(refused), 1u);
}

TEST(Check, BoxFamiliesAreHeldAgainstTheirKnownNumberOfPairs) {
    SceneSpec spec;
    spec.generator = "nested_boxes";
    spec.n = 30;
    const Scene scene = make_scene(spec);
    const auto all_but = [](std::uint32_t lost) {
        return made_up(Promise::exact, [lost](const Scene& s, Answers& answers) {
            std::vector<Pair>& pairs = list_of<Pair>(answers);
            pairs.clear();
            for (std::uint32_t b = 0; b < s.boxes.size(); ++b)
                for (std::uint32_t a = 0; a + lost < b; ++a)
                    pairs.push_back({a, b});
        });
    };
    EXPECT_EQ(broken_promises(checked(scene, "pairs", all_but(0))), 0u);
    const results::Results lost = checked(scene, "pairs", all_but(1));
    EXPECT_EQ(broken_promises(lost), 1u);
    EXPECT_EQ(lost.kernels[0].false_neg, 29u);
}

/// What the kernel named says, with `spoil` done to one hit.
ContenderEntry spoilt(const Task& task, const ContenderEntry& kernel,
                      const std::function<void(RayHit&)>& spoil) {
    return made_up(kernel.promise, [&task, kernel, spoil](const Scene& scene, Answers& answers) {
        const std::unique_ptr<Contender> right = kernel.make({&scene, &task});
        right->build();
        right->query(answers);
        spoil(list_of<RayHit>(answers).at(7));
    });
}

TEST(Check, OneWrongHitOfManyIsFound) {
    SceneSpec spec;
    spec.generator = "ray_in_mesh";
    spec.n = 64;
    const Scene scene = make_scene(spec);
    struct Fault {
        const char* what;
        bool exact_is_broken, watertight_is_broken;
        std::function<void(RayHit&)> spoil;
    };
    const std::vector<Fault> faults{
        {"none", false, false, [](RayHit&) {}},
        {"a leak", true, true, [](RayHit& hit) { hit = {}; }},
        {"t", true, true, [](RayHit& hit) { hit.t *= 1 + 0x1p-18f; }},
        {"u", true, true, [](RayHit& hit) { hit.u += 0x1p-18f; }},
        {"the triangle", true, true, [](RayHit& hit) { hit.triangle ^= 1; }}};
    for (const std::string_view name : {"ray_triangle", "rays_closest"})
        for (const ContenderEntry& kernel : find_task(name)->contenders_on_cases()) {
            if (kernel.promise == Promise::none ||
                (!kernel.layout.empty() && kernel.layout != "wide8"))
                continue;
            for (const Fault& fault : faults)
                EXPECT_EQ(broken_promises(checked(
                              scene, name, spoilt(*find_task(name), kernel, fault.spoil))) > 0,
                          kernel.promise == Promise::exact ? fault.exact_is_broken
                                                           : fault.watertight_is_broken)
                    << kernel.name << ": " << fault.what;
        }
}

TEST(Check, AllHitsLackNoneRepeatNoneAndAreInOrder) {
    SceneSpec spec;
    spec.generator = "ray_through_mesh";
    spec.n = 32;
    const Scene scene = make_scene(spec);
    const Task& task = *find_task("rays_all");
    using At = std::ptrdiff_t;
    struct Fault {
        const char* what;
        std::function<void(AllHits&, At)> spoil; ///< at the first of two hits of a ray
    };
    const std::vector<Fault> faults{
        {"none", [](AllHits&, At) {}},
        {"one is missing",
         [](AllHits& all, At k) {
             all.list.erase(all.list.begin() + k);
             all.hits.erase(all.hits.begin() + k);
         }},
        {"one is there twice",
         [](AllHits& all, At k) {
             all.list.insert(all.list.begin() + k, all.list[std::size_t(k)]);
             all.hits.insert(all.hits.begin() + k, all.hits[std::size_t(k)]);
         }},
        {"the order",
         [](AllHits& all, At k) {
             std::iter_swap(all.list.begin() + k, all.list.begin() + k + 1);
             std::iter_swap(all.hits.begin() + k, all.hits.begin() + k + 1);
         }},
        {"t", [](AllHits& all, At k) { all.hits[std::size_t(k)].t *= 1 + 0x1p-21f; }},
        {"the triangle", [](AllHits& all, At k) { all.hits[std::size_t(k)].triangle ^= 1; }}};
    for (const ContenderEntry& right : task.contenders_on_cases())
        for (const Fault& fault : faults) {
            if (right.layout != "wide8")
                continue;
            ContenderEntry wrong = made_up(right.promise, [&](const Scene& s, Answers& answers) {
                const std::unique_ptr<Contender> contender = right.make({&s, &task});
                contender->build();
                contender->query(answers);
                auto& all = dynamic_cast<AllHits&>(answers);
                const auto several =
                    std::ranges::adjacent_find(all.list, {}, &Pair::a) - all.list.begin();
                ASSERT_LT(std::size_t(several), all.list.size());
                fault.spoil(all, several);
            });
            wrong.kernel = right.kernel;
            EXPECT_EQ(broken_promises(checked(scene, "rays_all", wrong)) > 0,
                      fault.what != std::string("none"))
                << right.name << ": " << fault.what;
        }
}

TEST(CheckScenes, HoldTheEndsOfEveryFamilysScale) {
    CheckOptions options;
    options.only = "^slivers/triangle_triangle/";
    const std::vector<SceneSpec> scenes = check_scenes(options);
    const HardCaseFamily& family = *find_hard_case_family("slivers");
    ASSERT_EQ(scenes.size(), 3u);
    EXPECT_EQ(scenes.front().scale, family.scale_min);
    EXPECT_EQ(scenes[1].scale, 0);
    EXPECT_EQ(scenes.back().scale, family.scale_max);
    options.is_quick = true;
    const std::vector<SceneSpec> quick = check_scenes(options);
    ASSERT_EQ(quick.size(), 3u);
    EXPECT_EQ(quick[1].n, options.n);
    EXPECT_LT(quick.front().n, options.n);
    EXPECT_EQ(quick.front().n, quick.back().n);
    options.k = 5;
    options.scale = 7;
    ASSERT_EQ(check_scenes(options).size(), 1u);
    EXPECT_EQ(check_scenes(options)[0].k, 5);
    EXPECT_EQ(check_scenes(options)[0].scale, 7);
    options.k = 1000;
    EXPECT_THROW(check_scenes(options), BadInput);
    options.only = "no such thing";
    EXPECT_THROW(check_scenes(options), BadInput);
    options.only = "(";
    EXPECT_THROW(check_scenes(options), BadInput);
}

struct CheckCommand : testing::Test {
    const fs::path program =
        fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "boxwood";
    fs::path out =
        fs::temp_directory_path() / ("boxwood-check-" + std::to_string(getpid()) + ".h5");
    std::string text;

    void SetUp() override {
        if (!fs::exists(program))
            GTEST_SKIP() << program << " is not built";
    }
    void TearDown() override { fs::remove(out); }

    int run(const std::string& arguments) {
        FILE* pipe = popen((program.string() + " check " + arguments + " 2>&1").c_str(), "r");
        text.clear();
        std::array<char, 4096> block;
        for (std::size_t n; (n = fread(block.data(), 1, block.size(), pipe)) > 0;)
            text.append(block.data(), n);
        return WEXITSTATUS(pclose(pipe));
    }
};

TEST_F(CheckCommand, WritesAResultFileWithARowPerKernelAndScale) {
    ASSERT_EQ(run("--only '^slivers/triangle_(triangle|distance)/' --n 50 --out " + out.string()),
              0)
        << text;
    EXPECT_THAT(text, AllOf(HasSubstr("triangle_triangle  degenerate  guigue_devillers_exact "),
                            HasSubstr("triangle_distance  degenerate  rational "),
                            HasSubstr("Every promise is kept.")));
    const results::Results r = results::read(out);
    EXPECT_EQ(r.generator, "boxwood check");
    EXPECT_EQ(r.scenes.size(), 3u);
    EXPECT_EQ(r.kernels.size(), r.cells.size());
    EXPECT_EQ(r.checks.size(), r.cells.size());
    EXPECT_GE(r.cells.size(), 3 * (find_task("triangle_triangle")->kernels().size() +
                                   find_task("triangle_distance")->kernels().size()));
    EXPECT_FALSE(r.conditions.empty());
    for (const results::KernelRow& row : r.kernels) {
        EXPECT_EQ(row.family, "slivers");
        EXPECT_EQ(row.panel, "degenerate");
        EXPECT_TRUE(row.status == results::Status::unsupported || row.ns_per_call > 0)
            << row.kernel;
    }
}

TEST_F(CheckCommand, ReplaysOneCase) {
    ASSERT_EQ(run("--only '^slivers/triangle_triangle/rational$' --scale 4 --n 20 --case 3"), 0)
        << text;
    EXPECT_THAT(text, AllOf(HasSubstr("slivers_scale4/triangle_triangle, case 3"),
                            HasSubstr("rational (f64)"), HasSubstr("truth ")));
}

TEST_F(CheckCommand, ExplainsBadUsage) {
    EXPECT_EQ(run("--only nothing_like_it"), 2);
    EXPECT_THAT(text, HasSubstr("boxwood list families"));
    EXPECT_EQ(run("--only '^slivers/triangle_triangle/rational$' --scale 0 --n 5 --case 5"), 2);
    EXPECT_THAT(text, HasSubstr("has 5 cases"));
    EXPECT_EQ(run("--case 1"), 2);
    EXPECT_EQ(run("--help"), 0);
    EXPECT_THAT(text, HasSubstr("Examples:"));
}

} // namespace
} // namespace boxwood::bench
