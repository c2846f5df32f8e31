#include "bench/analysis/tree_rankings.h"

#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

TEST(TreeRankings, GiveTimeAndSahCostAgainstEachQuality) {
    RunForTest run;
    const auto add = [&](const char* variant, double ns, double sah) {
        const auto cell = run.cell("uniform", 1000, "build", variant);
        run.time(cell, "build", ns);
        results::TreeRow row;
        row.cell_id = cell;
        row.sah_cost = sah;
        run.results.trees.push_back(row);
    };
    add("lbvh.tree", 20'000, 110);
    add("embree.rtc_build_bvh.low", 60'000, 100);
    add("embree.rtc_build_bvh.medium", 100'000, 80);
    const std::string text = tree_rankings_text(RunIndex(run.results));
    EXPECT_THAT(text, HasSubstr("time of low/ours"));
    EXPECT_THAT(text, HasSubstr("SAH ours/medium"));
    // 1000 boxes in 20 us are 50 million a second.
    EXPECT_THAT(text, ContainsRegex("lbvh.tree +20.0 us +50.0 +110 +3.00 \\[3.00, 3.00\\] +1.10 "
                                    "+5.00 \\[5.00, 5.00\\] +1.38"));
    EXPECT_EQ(ray_builds_text(RunIndex(run.results)), "");
}

TEST(TreeRankings, BuildsForRaysShowTheWorstOfTheirRays) {
    RunForTest run;
    const auto add = [&](const char* scene, const char* ask, const char* variant, double build,
                         double query) {
        const auto cell = run.cell(scene, 1000, ask, variant);
        run.time(cell, "build", build);
        run.time(cell, "query", query);
    };
    add("sphere_random", "rays_closest", "median.wide8.single_rays.moller_trumbore_f32", 100, 100);
    add("sphere_random", "rays_closest", "embree.rtc_intersect1", 400, 90);
    add("sphere_random", "rays_closest", "embree.rtc_intersect8", 400, 1);
    add("sphere_ambient", "rays_any", "median.wide8.single_rays.moller_trumbore_f32", 100, 100);
    add("sphere_ambient", "rays_any", "embree.rtc_occluded1", 100, 150);
    add("sphere_ambient", "rays_any", "embree.rtc_occluded1.robust", 100, 150);
    const std::string text = ray_builds_text(RunIndex(run.results));
    // Builds 4 and 1 times as fast, in the geometric mean 2; rays at worst 0.9.
    EXPECT_THAT(text,
                ContainsRegex("sphere +1000 +1 +against single rays +median.wide8 +2 +2.00 +0.900 "
                              "+sphere_random rays_closest"));
    EXPECT_THAT(text, Not(HasSubstr("watertight"))); // ours has no such kernel here
    EXPECT_THAT(text, Not(HasSubstr("against packets")));
}

} // namespace
} // namespace boxwood::bench
