#include "bench/running/isolated.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <csignal>
#include <stdexcept>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

TEST(Isolated, BringsEveryAnswerBack) {
    const Outcome outcome = isolated([](Outcome& out) {
        out.answers.pairs.assign(100'000, {1, 2}); // more than a pipe holds
        out.answers.hits = {{.5f, 0, 0, 3}};
        out.answers.verdicts = {{Answer::maybe, 2}};
        out.answers.distances.resize(1);
        out.answers.distances[0].hi = 7;
        out.answers.impacts = {{Answer::yes, .25, .5, 1}};
        out.answers.boxes = {{{0, 0, 0}, {1, 2, 3}}};
        out.ns = 42;
    });
    EXPECT_EQ(outcome.failure, "");
    EXPECT_EQ(outcome.ns, 42);
    ASSERT_EQ(outcome.answers.pairs.size(), 100'000u);
    EXPECT_EQ(outcome.answers.pairs.back(), (Pair{1, 2}));
    EXPECT_EQ(outcome.answers.hits.at(0).triangle, 3u);
    EXPECT_EQ(outcome.answers.verdicts.at(0), (Decision{Answer::maybe, 2}));
    EXPECT_EQ(outcome.answers.distances.at(0).hi, 7);
    EXPECT_EQ(outcome.answers.impacts.at(0).t_hit, .5);
    EXPECT_EQ(outcome.answers.boxes.at(0).max.z, 3);
}

TEST(Isolated, SaysHowItEnded) {
    EXPECT_THAT(isolated([](Outcome&) { raise(SIGKILL); }).failure, HasSubstr("crashed: signal 9"));
    EXPECT_EQ(isolated([](Outcome&) { _exit(3); }).failure, "crashed: exit code 3");
    EXPECT_EQ(isolated([](Outcome&) { _exit(0); }).failure, "crashed: exit code 0");
    EXPECT_EQ(isolated([](Outcome&) { throw std::runtime_error("no luck"); }).failure,
              "threw: no luck");
    EXPECT_EQ(isolated([](Outcome&) { pause(); }, 1).failure, "hung: no answer within 1 s");
}

TEST(Isolated, LeavesThisProcessAlone) {
    int here = 1;
    isolated([&](Outcome&) { here = 2; });
    EXPECT_EQ(here, 1);
}

} // namespace
} // namespace boxwood::bench
