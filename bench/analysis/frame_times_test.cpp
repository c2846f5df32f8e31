#include "bench/analysis/frame_times.h"

#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// A moving scene of 100 frames; frame f of a contender takes base + f microseconds, half of it
/// the query. Round 2 is disturbed.
RunForTest moving() {
    RunForTest run;
    for (const auto& [variant, base] : {std::pair{"auto.packed", 1000.0},
                                        {"merge.packed", 950.0},
                                        {"refit.packed", 990.0},
                                        {"fcl.tree", 20'000.0},
                                        {"bullet.dbvt", 9'000.0},
                                        {"bullet.dbvt.margin", 11'000.0}}) {
        const auto cell = run.cell("uniform_drift", 1000, "moving_pairs", variant);
        run.time(cell, "update", 500 * base);
        run.time(cell, "query", 500 * base);
        for (std::uint32_t round = 0; round < 3; ++round)
            for (std::uint32_t f = 0; f < 100; ++f) {
                const double half = (base + f) * 500 * (round == 2 ? 50 : 1);
                run.results.frames.push_back({cell, 0, round, f, half, half, 7});
            }
    }
    return run;
}

TEST(FrameTimes, AreThoseOfTheFramesAndNotOfADisturbedRound) {
    const RunForTest run = moving();
    const FrameStats stats = frame_stats(run.results).at(0);
    EXPECT_EQ(stats.n_frames, 100u);
    EXPECT_DOUBLE_EQ(stats.p50_ns, 1'049'500);
    EXPECT_DOUBLE_EQ(stats.p95_ns, 1'094'050);
    EXPECT_DOUBLE_EQ(stats.p99_ns, 1'098'010);
    EXPECT_DOUBLE_EQ(stats.worst_ns, 1'099'000);
    EXPECT_DOUBLE_EQ(stats.over_1ms, 0.99); // frame 0 takes 1 ms to the dot
    EXPECT_DOUBLE_EQ(stats.over_16ms, 0);
    EXPECT_DOUBLE_EQ(frame_stats(run.results).at(3).over_16ms, 1);
}

TEST(FrameTimes, InBriefKeepTheBestOfEachLibraryAndThePolicyAuto) {
    const RunForTest run = moving();
    const RunIndex index(run.results);
    const std::string all = frame_times_text(index, false), brief = frame_times_text(index, true);
    EXPECT_THAT(all, ContainsRegex("uniform_drift +1000 +1 +auto.packed +100 +1.05 ms +1.09 ms "
                                   "+1.10 ms +1.10 ms +99 % +0 %"));
    for (const char* kept : {"auto.packed", "merge.packed", "fcl.tree", "bullet.dbvt "}) {
        EXPECT_THAT(all, HasSubstr(kept));
        EXPECT_THAT(brief, HasSubstr(kept));
    }
    for (const char* left_out : {"refit.packed", "bullet.dbvt.margin"}) {
        EXPECT_THAT(all, HasSubstr(left_out));
        EXPECT_THAT(brief, Not(HasSubstr(left_out)));
    }
}

TEST(FrameTimes, InBriefAWholeSceneIsWhatItCallsFor) {
    RunForTest run;
    for (const auto& [variant, ns] : {std::pair{"required", 100.0}, {"all_stages", 90.0}}) {
        const auto cell = run.cell("rubble", 1000, "scene_queries", variant);
        run.time(cell, "update", ns);
        run.time(cell, "query", ns);
        run.results.frames.push_back({cell, 0, 0, 0, ns, ns, 7});
    }
    const std::string brief = frame_times_text(RunIndex(run.results), true);
    EXPECT_THAT(brief, HasSubstr("required"));
    EXPECT_THAT(brief, Not(HasSubstr("all_stages")));
}

TEST(FrameTimes, TheBestPeerIsTheQuickestOfAllLibraries) {
    RunForTest run = moving();
    EXPECT_THAT(frame_peers_text(RunIndex(run.results)),
                ContainsRegex("uniform_drift +1000 +1 +merge.packed +950 us +bullet.dbvt +9.00 ms "
                              "+9.47 \\[9.47, 9.47\\] +bullet, fcl\n"));
    run.results.checks[4].status = "wrong";
    EXPECT_THAT(frame_peers_text(RunIndex(run.results)),
                ContainsRegex("bullet.dbvt.margin +11.0 ms +11.6"));
    std::erase_if(run.results.cells, [](const auto& cell) { return cell.cell_id < 3; });
    EXPECT_EQ(frame_peers_text(RunIndex(run.results)), ""); // nothing of ours
}

} // namespace
} // namespace boxwood::bench
