#include "bench/tasks/detail/tree_task.h"

#include "bench/truth/truth.h"
#include "kernels/registry.h"
#include "kernels/testing/complaint.h"
#include "trees/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

ContenderEntry contender_of(const Choice& choice, std::string_view task) {
    return find_task(task)->contender(choice);
}

std::string complaint(const Choice& choice, std::string_view task) {
    return complaint_of([&] { contender_of(choice, task); });
}

TEST(OurContender, IsNamedByItsWords) {
    EXPECT_EQ(contender_of({"median", {}, "binary", "watertight", "given"}, "pairs").name,
              "median.binary.self_pairs");
    EXPECT_EQ(
        contender_of({"binned_sah", {{"bins", 16}}, "wide8", "watertight", "given"}, "tree_pairs")
            .name,
        "binned_sah_bins16.wide8.tree_pairs");
    const ContenderEntry rays =
        contender_of({"median", {}, "wide8", "watertight", "given"}, "rays_closest");
    EXPECT_EQ(rays.name, "median.wide8.rays.watertight");
    EXPECT_FALSE(rays.is_peer);
    EXPECT_EQ(rays.kernel, "watertight");
}

TEST(OurContender, RefusesUnknownWords) {
    EXPECT_THAT(complaint({"medain", {}, "wide8", "", "given"}, "pairs"), HasSubstr("'median'"));
    EXPECT_THAT(complaint({"median", {}, "wyde8", "", "given"}, "pairs"), HasSubstr("'wide8'"));
    EXPECT_THAT(complaint({"median", {}, "wide8", "watertigth", "given"}, "rays_any"),
                HasSubstr("'watertight'"));
    EXPECT_THAT(complaint({"binned_sah", {{"bin", 8}}, "wide8", "", "given"}, "pairs"),
                HasSubstr("bins"));
    EXPECT_THAT(complaint({"binned_sah", {{"bins", 1e9}}, "wide8", "", "given"}, "pairs"),
                HasSubstr("must be a whole number from"));
}

/// A triangle kernel that is never wrong.
std::string exact_triangles() {
    return std::string(
        std::ranges::find(triangle_kernels(), Promise::exact, &KernelInfo::promise)->name);
}

bool takes(const Task& task, std::string_view key) {
    return std::ranges::count(task.keys(), key) > 0;
}

/// Whether it is about triangles.
bool needs_mesh(const Task& task) {
    Scene boxes;
    boxes.boxes.resize(1);
    boxes.points.resize(1);
    boxes.regions.resize(1);
    return task.missing(boxes).has_value();
}

SceneSpec spec_of(const Task& task, std::size_t n) {
    SceneSpec spec;
    spec.generator = needs_mesh(task) ? "sphere_mesh" : "uniform";
    spec.n = n;
    spec.rays = takes(task, "rays") ? "random" : "";
    spec.n_rays = takes(task, "rays") ? 200 : 0;
    spec.n_points = takes(task, "n_points") ? 100 : 0;
    spec.regions = takes(task, "regions") ? "spheres" : "";
    return spec;
}

/// Builds and queries twice each; the answers are right, and so are those of the counted pass.
void expect_right(const Scene& scene, const Task& task, const ContenderEntry& entry,
                  unsigned threads, Truth& truth) {
    const Job job{&scene, &task, std::string(default_executor(threads)), threads};
    ASSERT_FALSE(entry.unsupported(job));
    const auto contender = entry.make(job);
    const auto answers = task.make_answers(), counted = task.make_answers();
    for (int again = 0; again < 2; ++again) {
        contender->build();
        for (int i = 0; i < 2; ++i)
            contender->query(*answers);
        const Judgement judged = truth.judge(*answers, entry);
        EXPECT_NE(judged.status, Status::wrong);
        EXPECT_EQ(judged.check.missing + judged.check.extra, 0u);
    }
    const auto work = contender->counted_query(*counted);
    ASSERT_EQ(work.has_value(), task.name() != "rays_all");
    if (work) {
        EXPECT_EQ(task.hash(*counted), task.hash(*answers));
    }
    EXPECT_GT(contender->structure()->bytes, 0u);
}

TEST(OurContender, AnswersAsTheTruthAlsoWhenBuiltAndQueriedAgain) {
    for (const Task* task : tasks())
        for (const std::size_t n : {1u, 2u, 3u, 700u}) {
            if (task->scenes() != SceneKind::still || !takes(*task, "layouts") ||
                task->phases() == Phases::build)
                continue; // no tree, no query, or many: see build_ and moving_pairs_test
            if (needs_mesh(*task) && n < 700)
                continue; // a sphere needs more triangles
            const Scene scene = make_scene(spec_of(*task, n));
            const auto truth = task->make_truth(scene, 1);
            for (const BuilderEntry& builder : builders())
                for (const LayoutEntry& layout : layouts())
                    for (const unsigned threads : {1u, 2u}) {
                        const ContenderEntry entry = task->contender(
                            {.builder = std::string(builder.name),
                             .settings = {},
                             .layout = std::string(layout.name),
                             .kernel = task->name() == "triangle_pairs" ? exact_triangles()
                                                                        : "watertight"});
                        EXPECT_EQ(entry.precision, layout.precision);
                        SCOPED_TRACE(testing::Message() << task->name() << " " << entry.name
                                                        << " n " << n << " threads " << threads);
                        expect_right(scene, *task, entry, threads, *truth);
                    }
        }
}

TEST(OurContender, RefusesTasksThatNoTreeAnswers) {
    EXPECT_THAT(complaint({}, "moving_pairs"), HasSubstr("moving_pairs"));
    EXPECT_THAT(complaint({}, "scene_queries"), HasSubstr("scene_queries"));
    EXPECT_THAT(complaint({}, "triangle_distance"), HasSubstr("triangle_distance"));
}

TEST(OurContender, SaysWhatItCannotDo) {
    const Task &pairs = *find_task("pairs"), &rays = *find_task("rays_any");
    const Scene boxes = make_scene(spec_of(pairs, 10));
    EXPECT_TRUE(contender_of({}, "rays_any").unsupported({&boxes, &rays, "serial", 1}));
    EXPECT_TRUE(contender_of({}, "pairs").unsupported({&boxes, &pairs, "serial", 2}));
    EXPECT_TRUE(contender_of({}, "pairs").unsupported({&boxes, &rays, "serial", 1}));
    EXPECT_FALSE(contender_of({}, "pairs").unsupported({&boxes, &pairs, "tbb", 2}));
}

} // namespace
} // namespace boxwood::bench
