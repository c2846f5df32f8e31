#include "bench/analysis/policies.h"

#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::ContainsRegex;

/// auto and two fixed policies, by what an update takes; queries take 100.
std::string text_of(double automatic, double refit, double merge, std::uint32_t rounds = 9) {
    RunForTest run;
    run.rounds = rounds;
    for (const auto& [variant, ns] : {std::pair{"auto.packed", automatic},
                                      {"refit.packed", refit},
                                      {"merge_margin2.packed", merge},
                                      {"auto_margin9.packed", 1.0},
                                      {"fcl.tree", 1.0}}) {
        const auto cell = run.cell("uniform_drift", 1000, "moving_pairs", variant);
        run.time(cell, "update", ns);
        run.time(cell, "query", 100);
    }
    return policies_text(RunIndex(run.results));
}

TEST(Policies, AutoIsHeldAgainstTheBestFixedOne) {
    EXPECT_THAT(
        text_of(100, 300, 90),
        ContainsRegex("uniform_drift +1000 +1 +auto +200 ns +merge_margin2 +190 ns +1.05 .* yes"));
    EXPECT_THAT(text_of(100, 50, 90), ContainsRegex("refit +150 ns +1.33 .* no\n"));
    EXPECT_THAT(text_of(10, 50, 90), ContainsRegex("refit +150 ns +0.733 .* yes"));
    EXPECT_THAT(text_of(100, 300, 90, 3), ContainsRegex("1.05 +can't tell"));
}

TEST(Policies, KeepIsHeldAgainstThoseThatFindAnew) {
    RunForTest run;
    for (const auto& [variant, ns] : {std::pair{"auto.packed", 50.0},
                                      {"refit.packed", 300},
                                      {"keep_margin3.packed", 10},
                                      {"cached.packed", 100}}) {
        const auto cell = run.cell("uniform_drift", 1000, "moving_pairs", variant);
        run.time(cell, "update", ns);
        run.time(cell, "query", 100);
    }
    const std::string text = policies_text(RunIndex(run.results));
    EXPECT_THAT(text, ContainsRegex("auto +150 ns +keep_margin3 +110 ns +1.36 .* no\n"));
    EXPECT_THAT(text, ContainsRegex("cached +200 ns +refit +400 ns +0.500 .* yes\n"));
}

TEST(Policies, NothingIsSaidWithoutAFixedPolicy) {
    RunForTest run;
    const auto cell = run.cell("uniform_drift", 1000, "moving_pairs", "auto.packed");
    run.time(cell, "update", 5);
    run.time(cell, "query", 5);
    EXPECT_EQ(policies_text(RunIndex(run.results)), "");
}

} // namespace
} // namespace boxwood::bench
