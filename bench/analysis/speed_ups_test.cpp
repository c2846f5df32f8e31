#include "bench/analysis/speed_ups.h"

#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

TEST(SpeedUps, OfTheBestOfOursPhaseByPhase) {
    RunForTest run;
    const auto add = [&](const char* variant, std::uint32_t threads, double build, double query) {
        const auto cell = run.cell("uniform", 1000, "pairs", variant, threads);
        run.time(cell, "build", build);
        run.time(cell, "query", query);
    };
    add("hilbert.packed", 1, 300, 100);
    add("hilbert.packed", 2, 200, 50);
    add("median.wide8", 1, 900, 900);
    add("median.wide8", 2, 450, 450);
    add("fcl.tree", 1, 9, 9);
    add("fcl.tree", 2, 3, 3);
    const std::string text = speed_ups_text(RunIndex(run.results));
    EXPECT_THAT(text, ContainsRegex("hilbert.packed +tbb-2 +1.50 \\[1.50, 1.50\\] +2.00 \\[2.00, "
                                    "2.00\\] +1.60 \\[1.60, 1.60\\]"));
    EXPECT_THAT(text, Not(HasSubstr("median.wide8"))); // never the best
    EXPECT_THAT(text, Not(HasSubstr("fcl")));
    EXPECT_THAT(text, Not(HasSubstr("update")));
}

TEST(SpeedUps, NothingIsSaidOfOneThread) {
    RunForTest run;
    run.time(run.cell("uniform", 1000, "pairs", "hilbert.packed"), "query", 5);
    EXPECT_EQ(speed_ups_text(RunIndex(run.results)), "");
}

} // namespace
} // namespace boxwood::bench
