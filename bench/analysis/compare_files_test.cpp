#include "bench/analysis/compare_files.h"

#include "bench/analysis/status.h"
#include "bench/testing/maker.h"

#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using results::Phase;
using results::Reason;
using results::Results;
using results::Verdict;

/// As two files read from disk are compared.
FileComparison compared(Results& base, Results& head) {
    set_statuses(base);
    set_statuses(head);
    return compare_files(base, head);
}

TEST(CompareFiles, AFileWithItselfIsTheSameAfterEnoughRounds) {
    for (const std::uint32_t rounds : {2u, 8u, 9u}) {
        Maker maker(rounds);
        maker.time(maker.cell("a", false), Phase::query, steady(100));
        maker.time(maker.cell("b", false), Phase::build, steady(100));
        const auto same = compared(maker.results, maker.results);
        ASSERT_EQ(same.rows.size(), 2u);
        for (const auto& row : same.rows) {
            EXPECT_EQ(row.comparison.verdict, rounds < 9 ? Verdict::cannot_tell : Verdict::same);
            EXPECT_EQ(row.comparison.ratio, 1);
            EXPECT_EQ(row.gate, Gate::passes); // whatever the noise: nothing is slower
            EXPECT_TRUE(row.is_same_samples);
        }
        EXPECT_TRUE(same.is_same_machine);
    }
}

TEST(CompareFiles, TheFloorIsThatOfTheNoisierFile) {
    Maker quiet(9), noisy(9);
    for (Maker* maker : {&quiet, &noisy}) {
        const auto cell = maker->cell("a", false);
        maker->time(cell, Phase::query, steady(100));
        maker->time(cell, Phase::query, steady(maker == &quiet ? 101 : 112), results::aa_twin);
    }
    EXPECT_NEAR(compared(quiet.results, noisy.results).floor.value(), 0.12, 1e-9);
    EXPECT_NEAR(compared(noisy.results, quiet.results).floor.value(), 0.12, 1e-9);
}

TEST(CompareFiles, FasterSlowerAndIdsOfBothFiles) {
    Maker base(9, "commit1"), head(9, "commit2", 1'000'000);
    base.time(base.cell("slower", false), Phase::query, steady(100));
    base.time(base.cell("faster", false), Phase::query, steady(100));
    base.time(base.cell("same", false), Phase::query, steady(100));
    head.cell("new", false);
    head.time(head.cell("same", false), Phase::query, steady(101));
    head.time(head.cell("faster", false), Phase::query, steady(80));
    head.time(head.cell("slower", false), Phase::query, steady(130));
    const auto result = compared(base.results, head.results);
    ASSERT_EQ(result.rows.size(), 3u);
    EXPECT_FALSE(result.is_same_machine);
    for (const auto& row : result.rows) {
        EXPECT_EQ(to_string(row.comparison.verdict), row.name);
        EXPECT_EQ(base.results.cells[row.comparison.cell_a].name, row.name);
        EXPECT_EQ(head.results.cells[row.comparison.cell_b].name, row.name);
    }
    EXPECT_NEAR(result.rows[2].comparison.ratio, 1.3, 0.01);
    EXPECT_TRUE(result.only_head.empty()); // never timed
}

TEST(CompareFiles, WhatCannotBeCompared) {
    Maker base(9), head(9);
    base.time(base.cell("gone", false), Phase::query, steady(100));
    base.time(base.cell("crashes", false), Phase::query, steady(100));
    base.time(base.cell("turns_wrong", false), Phase::query, steady(100));
    base.time(base.cell("other_scene", false), Phase::query, steady(100));
    head.time(head.cell("turns_wrong", false, results::Status::wrong), Phase::query, steady(100));
    head.cell("crashes", false, results::Status::wrong);
    head.time(head.cell("new", false), Phase::query, steady(100));
    head.results.scenes.push_back({});
    head.results.scenes[1].scene_id = 1;
    head.results.scenes[1].content_hash = 12;
    const auto other = head.cell("other_scene", false);
    head.results.cells[other].scene_id = 1;
    head.time(other, Phase::query, steady(100));
    const auto result = compared(base.results, head.results);
    EXPECT_EQ(result.lost, (std::vector<Lost>{{"crashes", "not timed"},
                                              {"gone", "not timed"},
                                              {"other_scene", "another scene"}}));
    EXPECT_EQ(result.only_head, std::vector<std::string>{"new"});
    ASSERT_EQ(result.rows.size(), 2u);
    for (const auto& row : result.rows) {
        EXPECT_TRUE(row.is_newly_wrong) << row.name;
        EXPECT_EQ(row.comparison.verdict, Verdict::wrong);
    }
    EXPECT_FALSE(compared(head.results, head.results).rows[0].is_newly_wrong);
}

} // namespace
} // namespace boxwood::bench
