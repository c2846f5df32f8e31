#include "bench/analysis/rankings.h"

#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

std::string text_of(const RunForTest& run) {
    return rankings_text(RunIndex(run.results), compare_to_peers(run.results));
}

std::vector<std::string> lanes(const std::string& ask, const std::string& variant) {
    RunForTest run;
    const auto cell = run.cell("sphere_random", 10, ask, variant);
    return lanes_of(run.results.cells[cell], run.variant_of(cell));
}

TEST(Rankings, RaysAreHeldAgainstTheirLike) {
    EXPECT_THAT(lanes("rays_closest", "embree.rtc_intersect1"),
                UnorderedElementsAre("against single rays", "batches against single rays"));
    EXPECT_THAT(lanes("rays_closest", "embree.rtc_intersect1.robust"),
                UnorderedElementsAre("against single rays, watertight",
                                     "batches against single rays, watertight"));
    EXPECT_THAT(lanes("rays_any", "embree.rtc_occluded16"),
                UnorderedElementsAre("against packets"));
    EXPECT_THAT(lanes("rays_any", "embree.rtc_occluded8.robust"),
                UnorderedElementsAre("against packets, watertight"));
    EXPECT_THAT(lanes("rays_any", "median.wide8.sorted_rays.moller_trumbore_f32"),
                UnorderedElementsAre("against packets"));
    EXPECT_THAT(lanes("rays_any", "median.wide8.rays.moller_trumbore_f32"),
                UnorderedElementsAre("against packets", "batches against single rays"));
    EXPECT_THAT(lanes("rays_any", "median.wide8.single_rays.moller_trumbore_f32"),
                UnorderedElementsAre("against single rays"));
    EXPECT_THAT(lanes("rays_any", "median.wide8.single_rays.watertight"),
                UnorderedElementsAre("against single rays", "against single rays, watertight"));
    EXPECT_THAT(lanes("rays_any", "median.wide8.rays.watertight"),
                UnorderedElementsAre("against packets", "batches against single rays",
                                     "against packets, watertight",
                                     "batches against single rays, watertight"));
    EXPECT_THAT(lanes("pairs", "fcl.tree"), UnorderedElementsAre(""));
}

TEST(Rankings, AWatertightPeerIsNoRivalOfALooserKernel) {
    RunForTest run;
    const auto task = [&](const char* scene, const char* variant, double ns) {
        const auto cell = run.cell(scene, 1000, "rays_closest", variant);
        run.time(cell, "build", 100);
        run.time(cell, "query", ns);
    };
    for (const char* scene : {"sphere_random", "soup_random"}) {
        ask(scene, "median.wide8.single_rays.moller_trumbore_f32", 100);
        ask(scene, "median.wide8.single_rays.watertight", 200);
        ask(scene, "embree.rtc_intersect1", scene[1] == 'p' ? 100 : 400);
        ask(scene, "embree.rtc_intersect1.robust", 300);
    }
    const std::string text = text_of(run);
    EXPECT_THAT(text, ContainsRegex("rays_closest, against single rays +1 +embree.rtc_intersect1 "
                                    ".*1.00 \\[1.00, 1.00\\]"));
    EXPECT_THAT(text, ContainsRegex("rays_closest, against single rays, watertight +1 "
                                    "+embree.rtc_intersect1.robust .*1.50 \\[1.50, 1.50\\]"));
    // Geometric means of 1 and 4, of 1.5 and 1.5.
    EXPECT_THAT(
        text, ContainsRegex("against single rays +10.3 +1 +embree +2 +2.00 +1.00 +sphere_random"));
    EXPECT_THAT(text,
                ContainsRegex("against single rays, watertight +10.3 +1 +embree +2 +1.50 +1.50"));
    EXPECT_THAT(text, Not(HasSubstr("against packets"))); // no peer walks them here
}

TEST(Rankings, FramesAreRankedByUpdateAndQueryTogether) {
    RunForTest run;
    for (const auto& [variant, update] : {std::pair{"auto.packed", 100.0}, {"fcl.tree", 900.0}}) {
        const auto cell = run.cell("uniform_drift", 1000, "moving_pairs", variant);
        run.time(cell, "build", 5);
        run.time(cell, "update", update);
        run.time(cell, "query", 100);
    }
    const std::string text = text_of(run);
    EXPECT_THAT(text, HasSubstr("update+query, peer/ours"));
    EXPECT_THAT(text, HasSubstr("5.00 [5.00, 5.00] faster"));
    EXPECT_THAT(text, Not(HasSubstr("build")));
}

TEST(Rankings, SayHowFarFromTheLimitOursIs) {
    // 1000 boxes at 1 GB/s: 88000 ns to build. 4000 pairs at 1 GHz: 24000 + 32000 ns of bytes.
    RunForTest run;
    const auto cell = run.cell("uniform", 1000, "pairs", "hilbert.packed");
    run.time(cell, "build", 176'000);
    run.time(cell, "query", 112'000);
    run.results.counters = {{cell, "box_tests", 100}, {cell, "pairs", 4000}};
    EXPECT_THAT(text_of(run), ContainsRegex("hilbert.packed +176 us +112 us +2.00"));
    EXPECT_THAT(ranked_cells(RunIndex(run.results)), UnorderedElementsAre(cell));
}

TEST(Rankings, TreesAloneStandElsewhere) {
    RunForTest run;
    run.time(run.cell("uniform", 1000, "build", "lbvh.tree"), "build", 5);
    EXPECT_EQ(text_of(run), "");
}

} // namespace
} // namespace boxwood::bench
