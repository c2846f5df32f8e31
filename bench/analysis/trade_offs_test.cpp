#include "bench/analysis/trade_offs.h"

#include "bench/analysis/analyse.h"
#include "bench/testing/run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boxwood::bench {
namespace {

using results::Phase;

std::uint32_t add_pairs(RunForTest& run, const char* variant, double build_ns, double query_ns) {
    const auto cell = run.cell("uniform", 100, "pairs", variant);
    run.time(cell, Phase::build, build_ns);
    run.time(cell, Phase::query, query_ns);
    return cell;
}

TEST(TradeOffs, JoinThoseThatNoneBettersInBuildAndQuery) {
    RunForTest run;
    add_pairs(run, "worse", 300, 950);
    const auto best = add_pairs(run, "best", 900, 100), cheap = add_pairs(run, "cheap", 100, 900),
               middle = add_pairs(run, "middle", 400, 500);
    const auto wrong = add_pairs(run, "wrong", 1, 1);
    run.results.checks[wrong].status = results::Status::wrong;
    analyse(run.results);
    const auto& rows = run.results.break_even;
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].cell_a, results::no_id);
    EXPECT_EQ(rows[0].cell_b, cheap);
    EXPECT_TRUE(std::isnan(rows[0].queries));
    EXPECT_EQ(rows[1].cell_a, cheap);
    EXPECT_EQ(rows[1].cell_b, middle);
    EXPECT_DOUBLE_EQ(rows[1].queries, 300. / 400);
    EXPECT_EQ(rows[2].cell_b, best);
    EXPECT_DOUBLE_EQ(rows[2].queries, 500. / 400);
    const auto noisy = trade_offs_of(run.results, 3.5); // 400 is within that of 100
    EXPECT_TRUE(std::isnan(noisy[1].queries));
}

TEST(TradeOffs, BreakEvenIsAboveTheFloorOnBothSides) {
    for (const auto& [build, query] : {std::pair{105., 500.}, {400., 880.}}) {
        RunForTest run;
        const auto cheap = add_pairs(run, "cheap", 100, 900);
        add_pairs(run, "dear", build, query);
        analyse(run.results);
        ASSERT_EQ(run.results.break_even.size(), 2u);
        EXPECT_FALSE(std::isnan(run.results.break_even[1].queries));
        run.time(cheap, Phase::query, 900 * 1.1);
        for (std::size_t i = run.results.samples.size() - run.rounds;
             i < run.results.samples.size(); ++i)
            run.results.samples[i].flags = results::aa_twin;
        analyse(run.results); // with a floor of 10 %
        EXPECT_TRUE(std::isnan(run.results.break_even[1].queries)) << build << " and " << query;
    }
}

TEST(TradeOffs, OneAloneIsTheBest) {
    RunForTest run;
    const auto cell = add_pairs(run, "alone", 100, 100);
    analyse(run.results);
    ASSERT_EQ(run.results.break_even.size(), 1u);
    EXPECT_EQ(run.results.break_even[0].cell_b, cell);
}

TEST(TradeOffs, MarkBuildersThatNoneBettersInTimeAndCost) {
    RunForTest run;
    const auto add = [&](const char* variant, double build, double cost) {
        const auto cell = run.cell("uniform", 100, "build", variant);
        run.time(cell, Phase::build, build);
        results::TreeRow tree;
        tree.cell_id = cell;
        tree.sah_cost = cost;
        run.results.trees.push_back(tree);
        return cell;
    };
    const auto wrong = add("wrong", 1, 1);
    run.results.checks[wrong].status = results::Status::wrong;
    const std::vector<std::uint32_t> expected{0, 1, 0, 1, 0};
    add("fast", 10, 90);
    add("slower_and_dearer", 20, 95);
    add("slower_and_better", 30, 50);
    add("slower_and_the_same", 40, 50);
    analyse(run.results);
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(run.results.trees[i].on_front, expected[i]) << i;
    set_tree_fronts(run.results, 2.5); // 30 is within that of 10
    EXPECT_EQ(run.results.trees[1].on_front, 0u);
    EXPECT_EQ(run.results.trees[3].on_front, 1u);
}

} // namespace
} // namespace boxwood::bench
