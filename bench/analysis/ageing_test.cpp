#include "bench/analysis/ageing.h"

#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// A cell of frames; `growth` per frame of 5 box tests per item, and twice that of an SAH of 200.
/// Round 1 comes first in the file, and counts nothing.
std::uint32_t play(RunForTest& run, const char* variant, double growth, std::uint32_t frames = 11,
                   std::uint32_t threads = 1) {
    const auto cell = run.cell("uniform_drift", 1000, "moving_pairs", variant, threads);
    for (const std::uint32_t round : {1u, 0u})
        for (std::uint32_t f = 0; f < frames; ++f) {
            results::FrameRow row{cell, 0, round, f, 1, 1, 7};
            if (round == 0 && variant != std::string("fcl.tree")) {
                row.box_tests = static_cast<std::uint64_t>(5000 * (1 + growth * f));
                row.sah = 200 * (1 + 2 * growth * f);
            }
            run.results.frames.push_back(row);
        }
    return cell;
}

TEST(Ageing, IsTheLastFrameOverTheFirst) {
    RunForTest run;
    play(run, "auto.packed", 0);
    play(run, "refit.packed", .1);
    play(run, "refit.packed", .1, 11, 2); // counts as much, and is shown once
    play(run, "refine.packed", .05);
    play(run, "merge.packed", 0, 9);
    play(run, "fcl.tree", 0);
    const auto wrong = play(run, "rebuild.packed", 0);
    run.results.checks[wrong].status = "wrong";
    const RunIndex index(run.results);
    const std::string all = ageing_text(index, false), brief = ageing_text(index, true);
    for (const std::string& text : {all, brief}) {
        EXPECT_THAT(text, ContainsRegex("uniform_drift +1000 +auto +11 +5.00 +1.00 +200 +1.00"));
        EXPECT_THAT(text, ContainsRegex("uniform_drift +1000 +refit +11 +5.00 +2.00 +200 +3.00"));
        EXPECT_EQ(text.find("refit"), text.rfind("refit"));
        for (const char* left_out : {"merge", "fcl", "rebuild"})
            EXPECT_THAT(text, Not(HasSubstr(left_out)));
    }
    EXPECT_THAT(all, HasSubstr("refine"));
    EXPECT_THAT(brief, Not(HasSubstr("refine")));
}

TEST(Ageing, OfAFileThatDidNotCountThereIsNothing) {
    RunForTest run;
    play(run, "fcl.tree", 0);
    EXPECT_EQ(ageing_text(RunIndex(run.results), false), "");
    EXPECT_EQ(ageing_text(RunIndex(run.results), true), "");
}

} // namespace
} // namespace boxwood::bench
