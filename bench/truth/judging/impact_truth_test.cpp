/// Times of touch that are right and wrong, and what they are judged to be worth.

#include "bench/testing/judged.h"
#include "kernels/continuous/continuous_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace boxwood::bench {
namespace {

TEST(ImpactTruth, ATimeOfTouchMustNotBeCalledFree) {
    // A vertex falls onto a triangle that lies still: touch at t = 1/2.
    Scene scene;
    MotionCases cases;
    LinearMotion motion;
    motion.start = {{{.25, .25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    motion.end = motion.start;
    motion.end[0].z = -1;
    cases.motions = {{motion, Known::yes}};
    scene.cases = cases;
    const auto judge = [&](Impact impact, Promise promise) {
        return judged(scene, "vertex_face", answers_of<Impact>({impact}), named(promise));
    };
    EXPECT_EQ(judge({Answer::yes, .5, .5, 0}, Promise::exact).status, Status::exact);
    EXPECT_FALSE(is_broken(judge({Answer::yes, .5, std::nextafter(.5, 1), 0}, Promise::exact)));
    EXPECT_TRUE(is_broken(judge({Answer::yes, .25, .75, 0}, Promise::exact)));
    EXPECT_FALSE(is_broken(judge({Answer::yes, .25, .75, 0}, Promise::certified)));
    EXPECT_FALSE(is_broken(judge({Answer::maybe, .25, .75, 0}, Promise::never_miss)));
    EXPECT_TRUE(is_broken(judge({Answer::no, 1, 1, 0}, Promise::never_miss)));
    const Judgement late = judge({Answer::yes, .625, .75, 0}, Promise::never_miss);
    EXPECT_TRUE(is_broken(late));
    EXPECT_EQ(late.kernel->bound_violations, 1u);
    EXPECT_TRUE(is_broken(judge({Answer::yes, .25, .375, 0}, Promise::certified)));
    const double before = std::nextafter(.5, 0), after = std::nextafter(.5, 1);
    EXPECT_FALSE(is_broken(judge({Answer::yes, before, .5, 0}, Promise::exact)));
    EXPECT_TRUE(is_broken(judge({Answer::yes, after, after, 0}, Promise::exact)));
    EXPECT_TRUE(is_broken(judge({Answer::yes, before, before, 0}, Promise::exact)));
    EXPECT_EQ(judge({Answer::yes, .625, .625, 0}, Promise::none).status, Status::exact);
    EXPECT_EQ(judge({Answer::yes, .625, .625, 0}, Promise::none).kernel->max_rel_err, .125);
}

TEST(ImpactTruth, WhatNeverTouchesIsFreeForAllTimes) {
    Scene scene;
    MotionCases cases;
    LinearMotion motion; // a vertex stays above a triangle
    motion.start = {{{.25, .25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    motion.end = motion.start;
    cases.motions = {{motion, Known::no}};
    scene.cases = cases;
    const auto is_right = [&](Impact impact, Promise promise) {
        return !is_broken(
            judged(scene, "vertex_face", answers_of<Impact>({impact}), named(promise)));
    };
    constexpr double inf = std::numeric_limits<double>::infinity(),
                     nan = std::numeric_limits<double>::quiet_NaN();
    for (const Promise promise : {Promise::exact, Promise::never_miss}) {
        EXPECT_TRUE(is_right({Answer::no, 1, inf, 0}, promise));
        EXPECT_FALSE(is_right({Answer::no, .3, inf, 0}, promise));
        EXPECT_FALSE(is_right({Answer::no, nan, inf, 0}, promise));
        EXPECT_FALSE(is_right({Answer::no, 1, .5, 0}, promise));
    }
    EXPECT_TRUE(is_right({Answer::maybe, 0, 1, 0}, Promise::never_miss));
    EXPECT_FALSE(is_right({Answer::maybe, -1, 1, 0}, Promise::never_miss));
    EXPECT_TRUE(is_right({Answer::no, .3, .5, 0}, Promise::none));
}

} // namespace
} // namespace boxwood::bench
