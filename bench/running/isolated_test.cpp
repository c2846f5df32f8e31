#include "bench/running/isolated.h"

#include "kernels/continuous/continuous_kernel.h"
#include "kernels/decision.h"
#include "kernels/primitives/ray.h"
#include "kernels/triangle_distance/distance_kernel.h"
#include "trees/queries/sinks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <csignal>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

/// What comes back of such a list and a time.
template <class T> void expect_back(const std::vector<T>& list) {
    AnswerList<T> answers;
    answers.list.resize(3); // of an earlier query
    const Outcome outcome = isolated(answers, [&](Answers& out) {
        list_of<T>(out) = list;
        return 42.;
    });
    EXPECT_EQ(outcome.failure, "");
    EXPECT_EQ(outcome.ns, 42);
    ASSERT_EQ(answers.size(), list.size());
    EXPECT_EQ(std::memcmp(answers.list.data(), list.data(), list.size() * sizeof(T)), 0);
}

TEST(Isolated, BringsEveryAnswerBack) {
    expect_back(std::vector<Pair>(100'000, {1, 2})); // more than a pipe holds
    expect_back(std::vector<Pair>{});
    expect_back(std::vector<RayHit>{{.5f, 0, 0, 3}});
    expect_back(std::vector<Decision>{{Answer::maybe, 2}});
    expect_back(std::vector<Distance>(2));
    expect_back(std::vector<Impact>{{Answer::yes, .25, .5, 1}});
    expect_back(std::vector<Aabb<double>>{{{0, 0, 0}, {1, 2, 3}}});
}

/// Of work that never gives a time.
std::string failure_of(const std::function<void()>& work, int timeout_s = 60) {
    AnswerList<Pair> answers;
    return isolated(
               answers,
               [&](Answers&) {
                   work();
                   return 0.;
               },
               timeout_s)
        .failure;
}

TEST(Isolated, SaysHowItEnded) {
    EXPECT_THAT(failure_of([] { raise(SIGKILL); }), HasSubstr("crashed: signal 9"));
    EXPECT_EQ(failure_of([] { _exit(3); }), "crashed: exit code 3");
    EXPECT_EQ(failure_of([] { _exit(0); }), "crashed: exit code 0");
    EXPECT_EQ(failure_of([] { throw std::runtime_error("no luck"); }), "threw: no luck");
    EXPECT_EQ(failure_of([] { pause(); }, 1), "hung: no answer within 1 s");
}

TEST(Isolated, LeavesThisProcessAlone) {
    int here = 1;
    failure_of([&] { here = 2; });
    EXPECT_EQ(here, 1);
}

} // namespace
} // namespace boxwood::bench
