#include "bench/truth/first_meeting_truth.h"

#include "bench/tasks/detail/mesh_pair_answers.h"
#include "kernels/primitives/rotation.h"

#include <gtest/gtest.h>

#include <numbers>

namespace boxwood::bench {
namespace {

/// What is said to be wrong of two motions, to and fro.
results::Check judged(const Scene& scene, FirstMeeting to, FirstMeeting fro) {
    AnswerList<FirstMeeting> answers;
    answers.list = {to, fro};
    return make_first_meeting_truth(scene, 1)->judge(answers, {}).check;
}
results::Check judged(const Scene& scene, FirstMeeting both) { return judged(scene, both, both); }
bool is_right(const Scene& scene, FirstMeeting both) {
    const results::Check check = judged(scene, both);
    return check.missing == 0 && check.extra == 0;
}

/// A triangle that falls through a copy of it from 2 above to 2 below and comes back.
TEST(FirstMeetingTruth, KnowsWhenATriangleFallsThroughAnother) {
    Scene scene;
    scene.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    scene.poses.resize(2);
    scene.poses[0].translation = {.1, .1, 2};
    scene.poses[1].translation = {.1, .1, -2};
    for (const char* motion : {"linear", "screw"}) {
        scene.spec.motion = motion;
        EXPECT_TRUE(is_right(scene, {.5, .5, Meets::yes}));
        EXPECT_TRUE(is_right(scene, {.499999, .500001, Meets::yes}));
        EXPECT_TRUE(is_right(scene, {.499999, 1, Meets::left_open}));
        // What says next to nothing is no answer.
        EXPECT_EQ(judged(scene, {.25, .5, Meets::yes}).extra, 2u);
        EXPECT_EQ(judged(scene, {0, 1, Meets::left_open}).extra, 2u);
        EXPECT_EQ(judged(scene, {.4, .49, Meets::yes}).extra, 2u);
        EXPECT_EQ(judged(scene, {.25, .2, Meets::yes}).extra, 2u);
    }
}

/// A triangle in a half-plane that ends at an upright axis swings about it by 120 degrees, to the
/// other side of the copy that stays: they meet half-way if it is a screw motion about that axis,
/// and not at all if the distant origin goes straight.
TEST(FirstMeetingTruth, KnowsAScrewFromALinearMotion) {
    const Vec3<double> place{40, 0, 0};
    Scene scene;
    scene.mesh = {{{41, 0, -1}, {43, 0, -1}, {42, 0, 1}}, {{0, 1, 2}}};
    for (const double angle : {std::numbers::pi / 3, -std::numbers::pi / 3}) {
        RigidTransform<double>& pose = scene.poses.emplace_back();
        pose.rotation = rotation_about({0, 0, 1}, angle);
        pose.translation = place - pose(place); // the axis stays
    }
    scene.spec.motion = "screw";
    EXPECT_TRUE(is_right(scene, {.49999, .5, Meets::yes}));
    EXPECT_EQ(judged(scene, {.4, .45, Meets::yes}).extra, 2u);
    scene.spec.motion = "linear";
    EXPECT_TRUE(is_right(scene, {1, 1, Meets::no}));
    EXPECT_EQ(judged(scene, {.49999, .5, Meets::yes}).extra, 2u);
}

TEST(FirstMeetingTruth, SeesWhatIsPassedThrough) {
    Scene scene; // a pyramid, whose copy stands a little beside it
    scene.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                  {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}};
    scene.poses.resize(2);
    scene.poses[0].translation = {.1, .1, 3};
    scene.poses[1].translation = {.1, .1, -3};
    scene.spec.motion = "linear";
    // Downwards its lowest corner meets the slope, at height .8; upwards its top meets the floor.
    const double down = (3 - .8) / 6, up = (3. - 1) / 6;
    const auto both = [&](double earlier, double later) {
        return judged(scene, {down - earlier, down + later, Meets::yes},
                      {up - earlier, up + later, Meets::yes});
    };
    EXPECT_EQ(both(1e-7, 0).missing + both(1e-7, 0).extra, 0u);
    EXPECT_EQ(both(-.001, .001).missing, 2u);
    EXPECT_EQ(both(.01, -.01).extra, 2u);
    const results::Check never = judged(scene, {1, 1, Meets::no});
    EXPECT_EQ(never.missing, 2u);
    EXPECT_NE(never.witness.find("motion 0: said to be free until 1, and at"), std::string::npos)
        << never.witness;
}

} // namespace
} // namespace boxwood::bench
