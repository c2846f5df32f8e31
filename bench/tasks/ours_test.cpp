#include "bench/tasks/ours.h"

#include "bench/truth/truth.h"
#include "kernels/registry.h"
#include "trees/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

std::string complaint(const Choice& choice, Ask ask) {
    try {
        our_contender(choice, ask);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "(accepted)";
}

TEST(OurContender, IsNamedByItsWords) {
    EXPECT_EQ(our_contender({"median", {}, "binary", "watertight"}, Ask::pairs).name,
              "median.binary.self_pairs");
    EXPECT_EQ(
        our_contender({"binned_sah", {{"bins", 16}}, "wide8", "watertight"}, Ask::tree_pairs).name,
        "binned_sah_bins16.wide8.tree_pairs");
    const ContenderEntry rays =
        our_contender({"median", {}, "wide8", "watertight"}, Ask::rays_closest);
    EXPECT_EQ(rays.name, "median.wide8.rays.watertight");
    EXPECT_FALSE(rays.is_peer);
    EXPECT_EQ(rays.kernel, "watertight");
}

TEST(OurContender, RefusesUnknownWords) {
    EXPECT_THAT(complaint({"medain", {}, "wide8", ""}, Ask::pairs), HasSubstr("'median'"));
    EXPECT_THAT(complaint({"median", {}, "wyde8", ""}, Ask::pairs), HasSubstr("'wide8'"));
    EXPECT_THAT(complaint({"median", {}, "wide8", "watertigth"}, Ask::rays_any),
                HasSubstr("'watertight'"));
    EXPECT_THAT(complaint({"binned_sah", {{"bin", 8}}, "wide8", ""}, Ask::pairs),
                HasSubstr("bins"));
    EXPECT_THAT(complaint({"binned_sah", {{"bins", 1e9}}, "wide8", ""}, Ask::pairs),
                HasSubstr("must lie between"));
}

/// A triangle kernel that is never wrong.
std::string exact_triangles() {
    return std::string(
        std::ranges::find(triangle_kernels(), Promise::exact, &KernelInfo::promise)->name);
}

SceneSpec spec_of(Ask ask, std::size_t n) {
    SceneSpec spec;
    spec.generator = takes_kernel(ask) || ask == Ask::closest_points ? "sphere_mesh" : "uniform";
    spec.n = n;
    spec.rays = is_ray_ask(ask) ? "random" : "";
    spec.n_rays = is_ray_ask(ask) ? 200 : 0;
    spec.n_points = is_point_ask(ask) ? 100 : 0;
    spec.regions = ask == Ask::regions ? "spheres" : "";
    return spec;
}

TEST(OurContender, AnswersAsTheTruthAlsoWhenBuiltAndAskedAgain) {
    for (const AskEntry& ask : asks())
        for (const std::size_t n : {1u, 2u, 3u, 700u}) {
            if (is_kernel_ask(ask.task) || ask.task == Ask::tree || is_moving_ask(ask.task))
                continue; // no tree, no question, or many: see tree_builds_ and moving_pairs_test
            if ((takes_kernel(ask.task) || ask.task == Ask::closest_points) && n < 700)
                continue; // a sphere needs more triangles
            const Scene scene = make_scene(spec_of(ask.task, n));
            const auto truth = make_truth(scene, ask.task, 1);
            for (const BuilderEntry& builder : builders())
                for (const LayoutEntry& layout : layouts())
                    for (const unsigned threads : {1u, 2u}) {
                        const ContenderEntry entry = our_contender(
                            {std::string(builder.name),
                             {},
                             std::string(layout.name),
                             ask.task == Ask::triangle_pairs ? exact_triangles() : "watertight"},
                            ask.task);
                        const Job job{&scene, ask.task, threads == 1 ? "serial" : "tbb", threads};
                        ASSERT_FALSE(entry.unsupported(job)) << entry.name;
                        EXPECT_EQ(entry.precision, layout.precision);
                        const auto contender = entry.make(job);
                        Answers answers, counted;
                        for (int again = 0; again < 2; ++again) {
                            contender->build();
                            for (int i = 0; i < 2; ++i)
                                contender->query(answers);
                            const results::Check check = truth->check(answers);
                            EXPECT_NE(check.status, "wrong") << entry.name << " n " << n;
                            EXPECT_EQ(check.missing + check.extra, 0u) << entry.name << " n " << n;
                        }
                        const auto work = contender->counted_query(counted);
                        ASSERT_EQ(work.has_value(), ask.task != Ask::rays_all);
                        if (work) {
                            EXPECT_EQ(answer_hash(counted, ask.task), answer_hash(answers, ask.task));
                        }
                        EXPECT_GT(contender->structure()->bytes, 0u);
                    }
        }
}

TEST(OurContender, RefusesAsksThatNoTreeAnswers) {
    EXPECT_THAT(complaint({}, Ask::moving_pairs), HasSubstr("moving_pairs"));
    EXPECT_THAT(complaint({}, Ask::scene_queries), HasSubstr("scene_queries"));
    EXPECT_THAT(complaint({}, Ask::triangle_distance), HasSubstr("triangle_distance"));
}

TEST(OurContender, SaysWhatItCannotDo) {
    const Scene boxes = make_scene(spec_of(Ask::pairs, 10));
    const Choice choice;
    EXPECT_TRUE(
        our_contender(choice, Ask::rays_any).unsupported({&boxes, Ask::rays_any, "serial", 1}));
    EXPECT_TRUE(our_contender(choice, Ask::pairs).unsupported({&boxes, Ask::pairs, "serial", 2}));
    EXPECT_FALSE(our_contender(choice, Ask::pairs).unsupported({&boxes, Ask::pairs, "tbb", 2}));
}

} // namespace
} // namespace boxwood::bench
