#include "bench/analysis/ledgers.h"

#include "bench/analysis/effect_prices.h"
#include "bench/analysis/rankings.h"
#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// A warehouse of 10 frames, played three ways: 100, 400 and 80 ns a frame, all but 20 to update.
RunForTest warehouse() {
    RunForTest run;
    struct Row {
        const char* stage;
        std::uint32_t required;
        double ours_ns, all_ns; ///< of a frame
    };
    for (const auto& [variant, ns] : {std::pair{"required", 100.0},
                                      {"all_stages", 400.0},
                                      {"required.without_drift", 80.0}}) {
        const auto cell = run.cell("warehouse", 1000, "scene_queries", variant);
        run.time(cell, "update", [ns = ns](std::uint32_t round) { return ns - 20 + 0.1 * round; });
        run.time(cell, "query", 20);
        for (const Row& row :
             {Row{"advance_drift", 1, 20, 20}, Row{"fit", 1, 30, 130}, Row{"pairs", 1, 50, 50},
              Row{"transform", 0, 0, 200}, Row{"rays", 0, 0, 0}})
            for (std::uint32_t round = 0; round < 3; ++round) {
                const double stage_ns = variant[0] == 'e' ? row.all_ns : row.ours_ns;
                const bool ran = stage_ns > 0;
                run.results.effects.push_back(
                    {cell, 0, round, row.stage, row.required, ran ? 10u : 0u, ran ? 500u : 0u,
                     10 * stage_ns * (round == 1 ? 9 : 1), ran ? 2048u : 0u});
            }
    }
    run.results.scenes[0].n_frames = 10;
    return run;
}

TEST(Ledgers, SayWhatWasCalledForAndWhatWasNot) {
    const RunForTest run = warehouse();
    const std::string text = ledgers_text(RunIndex(run.results));
    EXPECT_THAT(text, ContainsRegex("warehouse +1000 +1 +advance_drift +yes +10 +50 +20.0 ns +20 % "
                                    "+2048 B +20.0 ns +5 % +2048 B\n"));
    EXPECT_THAT(text, ContainsRegex(" fit +yes +10 +50 +30.0 ns +30 % +2048 B +130 ns +32 %"));
    EXPECT_THAT(text, ContainsRegex(" transform +no +0 +0 +0 +0 % +0 B +200 ns +50 % +2048 B\n"));
    EXPECT_THAT(text, ContainsRegex("all stages +100 ns +400 ns\n"));
    EXPECT_THAT(text, HasSubstr("warehouse 1000: not called for, and so no call, no time, no "
                                "memory: rays\n"));
}

TEST(Ledgers, NeedTheSceneAsItIs) {
    RunForTest run = warehouse();
    run.results.checks[0].status = "wrong";
    EXPECT_EQ(ledgers_text(RunIndex(run.results)), "");
    EXPECT_EQ(everything_text(RunIndex(run.results)), "");
    EXPECT_EQ(effect_prices_text(RunIndex(run.results)), "");
    run = warehouse();
    run.results.checks[1].status = "wrong"; // everything
    EXPECT_THAT(ledgers_text(RunIndex(run.results)), Not(HasSubstr("400 ns")));
    EXPECT_EQ(everything_text(RunIndex(run.results)), "");
}

TEST(EffectPrices, ArePairedRatios) {
    const RunForTest run = warehouse();
    const RunIndex index(run.results);
    // Both sides grow by 0.8 ns in nine rounds.
    EXPECT_THAT(everything_text(index),
                ContainsRegex("warehouse +1000 +1 +100 ns +400 ns +3.99 \\[3.98, 4.00\\]\n"));
    EXPECT_THAT(effect_prices_text(index),
                ContainsRegex("warehouse +1000 +1 +drift +100 ns +80.4 ns +20.0 ns +1.25 \\[1.25, "
                              "1.25\\]\n"));
}

TEST(EffectPrices, ScenesAreNotRankedAmongQueries) {
    const RunForTest run = warehouse();
    EXPECT_EQ(rankings_text(RunIndex(run.results), {}), "");
}

} // namespace
} // namespace boxwood::bench
