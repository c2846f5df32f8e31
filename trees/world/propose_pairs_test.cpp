#include "trees/world/propose_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace boxwood {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Reason = AllowedReason;

/// A chain of balls one apart along x, hung on joints that slide along x: 0 .. 4. Link 2 is bare,
/// link 5 sits fixed on link 4, and link 6 fixed on link 5 far away.
Robot sliding_balls() {
    RobotDescription robot{"balls"};
    for (std::uint32_t i = 0; i < 7; ++i) {
        robot.links.push_back({"ball" + std::to_string(i)});
        if (i != 2)
            robot.links[i].geometries = {{LinkSphere{.25}, {}}};
    }
    for (std::uint32_t i = 1; i < 7; ++i)
        robot.joints.push_back({"joint" + std::to_string(i),
                                i < 5 ? JointKind::prismatic : JointKind::fixed,
                                i - 1,
                                i,
                                {.translation = {i < 5   ? 1.
                                                 : i < 6 ? .125
                                                         : 9.,
                                                 0, 0}},
                                {1, 0, 0},
                                -1,
                                1});
    return Robot(std::move(robot));
}

const auto balls_touch = [](std::uint32_t a, std::uint32_t b,
                            std::span<const RigidTransform<double>> poses) {
    return std::abs(poses[a].translation.x - poses[b].translation.x) <= .5;
};

TEST(ProposePairs, AdjacentLinksReachOverThoseWithoutGeometry) {
    const Robot robot = sliding_balls();
    AllowedPairs allowed = no_allowed_pairs(robot);
    allowed.allow("ball0", "ball1", Reason::user);
    EXPECT_EQ(allow_adjacent(robot, allowed), 4u);
    EXPECT_THAT(allowed.pairs(),
                ElementsAre(AllowedPair{0, 1, Reason::user}, AllowedPair{1, 3, Reason::adjacent},
                            AllowedPair{3, 4, Reason::adjacent},
                            AllowedPair{4, 5, Reason::adjacent},
                            AllowedPair{5, 6, Reason::adjacent}));
}

/// State i: the last value alternates, the others stay.
const auto alternate = [](std::uint64_t i, std::span<double> values) {
    std::ranges::fill(values, 0);
    values[3] = i % 2 == 0 ? 0 : -.875;
};

TEST(ProposePairs, SamplesSayAlwaysSometimesAndNever) {
    const Robot robot = sliding_balls();
    const LinkBoxes boxes(robot, {});
    AllowedPairs allowed = no_allowed_pairs(robot);
    std::set<std::pair<std::uint32_t, std::uint32_t>> asked;
    const auto collide = [&](std::uint32_t a, std::uint32_t b, auto poses) {
        EXPECT_FALSE(allowed.allows(a, b));
        asked.emplace(a, b);
        return balls_touch(a, b, poses);
    };
    const PairsBySampling counts =
        allow_by_samples(robot, boxes, {100, 7, alternate}, collide, allowed);
    // 3 and 4, 3 and 5 meet in every other state; 4 and 5 always, 4 and 6, 5 and 6 never: fixed.
    EXPECT_EQ(counts.always, 1u);
    EXPECT_EQ(counts.never, 2u);
    EXPECT_EQ(counts.sampled, 15u - 5);
    EXPECT_FALSE(allowed.allows(3, 4) || allowed.allows(3, 5));
    EXPECT_EQ(allowed.reason(4, 5), Reason::always);
    EXPECT_EQ(allowed.reason(4, 6), Reason::never);
    EXPECT_EQ(allowed.reason(0, 6), Reason::sampled);
    EXPECT_FALSE(allowed.reason(1, 2)); // without geometry: not looked at
    EXPECT_THAT(allowed.pairs().front().note, HasSubstr("in none of 100 samples, seed 7"));
    EXPECT_EQ(asked, (std::set<std::pair<std::uint32_t, std::uint32_t>>{{3, 4}, {3, 5}, {4, 5}}));
    EXPECT_LE(counts.tests, 5u); // each until it is decided
}

TEST(ProposePairs, PairsThatMeetInEverySampleAreAlways) {
    const Robot robot = sliding_balls();
    const LinkBoxes boxes(robot, {});
    AllowedPairs allowed = no_allowed_pairs(robot);
    const auto still = [](std::uint64_t, std::span<double> values) {
        std::ranges::fill(values, 0);
        values[0] = -.75;
    };
    allow_by_samples(robot, boxes, {3, 1, still}, balls_touch, allowed);
    EXPECT_EQ(allowed.reason(0, 1), Reason::always);
    EXPECT_THAT(allowed.pairs().front().note, HasSubstr("in each of 3 samples, seed 1"));
    EXPECT_THROW(allow_by_samples(robot, boxes, {0, 1, still}, balls_touch, allowed),
                 std::invalid_argument);
}

} // namespace
} // namespace boxwood
