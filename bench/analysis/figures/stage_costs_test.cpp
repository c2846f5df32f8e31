#include "bench/analysis/figures/stage_costs.h"

#include "bench/analysis/analyse.h"
#include "bench/testing/run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boxwood::bench {
namespace {

using results::Phase;

TEST(StageCosts, AreMediansOfARoundInAMeanFrame) {
    RunForTest run;
    const auto cell = run.cell("warehouse", 100, "scene_queries", "required");
    run.results.scenes[0].n_frames = 20;
    const auto stage = [&](const char* name, std::uint64_t calls, std::vector<double> ns) {
        for (const double total : ns) {
            results::EffectRow row;
            row.cell_id = cell;
            row.stage = name;
            row.required = calls > 0;
            row.calls = calls;
            row.items = 7 * calls;
            row.total_ns = total;
            row.bytes = 64;
            run.results.effects.push_back(row);
        }
    };
    stage("update", 20, {600, 200, 100});
    stage("transform", 0, {0, 0, 0});
    stage("pairs", 20, {300, results::missing, 900});
    const auto costs = stage_costs_of(run.results);
    ASSERT_EQ(costs.size(), 3u);
    EXPECT_EQ(costs[0].stage, "update");
    EXPECT_EQ(costs[0].ns, 10); // 200 in 20 frames
    EXPECT_EQ(costs[0].until_ns, 10);
    EXPECT_EQ(costs[0].items, 140u);
    EXPECT_EQ(costs[1].ns, 0);
    EXPECT_EQ(costs[1].required, 0u);
    EXPECT_EQ(costs[1].share, 0);
    EXPECT_EQ(costs[2].ns, 30); // between 300 and 900
    EXPECT_EQ(costs[2].until_ns, 40);
    EXPECT_EQ(costs[0].share, 0.25);
    EXPECT_EQ(costs[2].share, 0.75);
}

TEST(EffectCosts, AreThePairedRatiosAndWhatTheyAreWorth) {
    RunForTest run;
    const auto add = [&](const char* variant, double frame_ns) {
        const auto cell = run.cell("warehouse", 100, "scene_queries", variant);
        run.time(cell, Phase::update, frame_ns / 4);
        run.time(cell, Phase::query, frame_ns * 3 / 4);
        return cell;
    };
    const auto required = add("required", 1000), all = add("all_stages", 3000),
               without_drift = add("required.without_drift", 800);
    analyse(run.results);
    const auto& costs = run.results.effect_costs;
    ASSERT_EQ(costs.size(), 2u);
    for (const results::EffectCost& cost : costs) {
        const bool is_effect = cost.what == "drift";
        EXPECT_EQ(cost.what, is_effect ? "drift" : "all stages");
        EXPECT_EQ(cost.cell_with, is_effect ? required : all);
        EXPECT_EQ(cost.cell_without, is_effect ? without_drift : required);
        EXPECT_NEAR(cost.with_ns, is_effect ? 1000 : 3000, 1e-9);
        EXPECT_NEAR(cost.without_ns, is_effect ? 800 : 1000, 1e-9);
        EXPECT_NEAR(cost.ratio, is_effect ? 1.25 : 3, 1e-12);
        EXPECT_NEAR(cost.ci_lo, cost.ratio, 1e-12);
        EXPECT_NEAR(cost.extra_ns, is_effect ? 200 : 2000, 1e-9);
    }
    run.results.checks[all].status = results::Status::wrong;
    analyse(run.results);
    ASSERT_EQ(run.results.effect_costs.size(), 1u);
    EXPECT_EQ(run.results.effect_costs[0].what, "drift");
}

} // namespace
} // namespace boxwood::bench
