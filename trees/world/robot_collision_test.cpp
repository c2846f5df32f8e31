#include "trees/world/robot_collision.h"

#include "trees/world/propose_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace boxwood {
namespace {

/// One ball per link, about the link's origin; counts how often it is asked.
class Balls final : public LinkNarrowPhase {
  public:
    explicit Balls(const Robot& robot) : robot_(robot) {}
    bool collide(std::uint32_t a, std::uint32_t b,
                 std::span<const RigidTransform<double>> poses) const override {
        ++asked;
        return apart(a, b, poses) <= 0;
    }
    LinkDistance distance(std::uint32_t a, std::uint32_t b,
                          std::span<const RigidTransform<double>> poses,
                          double limit) const override {
        ++asked;
        const double d = std::max(0.0, apart(a, b, poses));
        return d < limit ? LinkDistance{d, d * (1 - 1e-12), d * (1 + 1e-12)}
                         : LinkDistance{.lo = limit};
    }
    double apart(std::uint32_t a, std::uint32_t b,
                 std::span<const RigidTransform<double>> poses) const {
        return length(poses[a].translation - poses[b].translation) - radius(a) - radius(b);
    }
    mutable std::size_t asked = 0;

  private:
    double radius(std::uint32_t link) const {
        return std::get<LinkSphere>(robot_.links()[link].geometries[0].shape).radius;
    }
    const Robot& robot_;
};

/// A snake of balls on revolute joints, in the plane; every fifth link is bare.
Robot snake(std::uint32_t n) {
    RobotDescription robot{"snake"};
    for (std::uint32_t i = 0; i < n; ++i) {
        robot.links.push_back({"ball" + std::to_string(i)});
        if (i % 5 != 4)
            robot.links[i].geometries = {{LinkSphere{.1 + .01 * i}, {}}};
        if (i > 0)
            robot.joints.push_back({"joint" + std::to_string(i),
                                    JointKind::revolute,
                                    i - 1,
                                    i,
                                    {.translation = {.5, 0, 0}},
                                    {0, 0, 1},
                                    -2,
                                    2});
    }
    return Robot(std::move(robot));
}

TEST(RobotSelfCollision, AgreesWithEveryPairTested) {
    const Robot robot = snake(14);
    const LinkBoxes boxes(robot, {});
    AllowedPairs allowed = no_allowed_pairs(robot);
    allow_adjacent(robot, allowed);
    const Balls balls(robot);
    RobotSelfCollision self(robot, boxes, allowed, balls);
    std::mt19937_64 random(6);
    std::vector<double> values(robot.n_values());
    int collided = 0;
    std::size_t asked = 0;
    for (int state = 0; state < 2000; ++state) {
        for (double& value : values)
            value = std::uniform_real_distribution<double>(-2, 2)(random);
        balls.asked = 0;
        const SelfCollision& found = self.check(values);
        asked += balls.asked;
        std::vector<Pair> candidates, tested, colliding;
        double least = INFINITY;
        for (const std::uint32_t a : boxes.links())
            for (const std::uint32_t b : boxes.links()) {
                if (a >= b)
                    continue;
                if (overlaps(self.boxes()[a], self.boxes()[b]))
                    candidates.push_back({a, b});
                if (allowed.allows(a, b))
                    continue;
                if (overlaps(self.boxes()[a], self.boxes()[b]))
                    tested.push_back({a, b});
                const double apart = balls.apart(a, b, self.poses());
                if (apart <= 0)
                    colliding.push_back({a, b});
                least = std::min(least, std::max(0.0, apart));
            }
        ASSERT_EQ(found.candidates, candidates);
        ASSERT_EQ(found.tested, tested);
        ASSERT_EQ(found.colliding, colliding);
        ASSERT_TRUE(found.nearest);
        ASSERT_NEAR(found.least.distance, least, 1e-14);
        ASSERT_LE(found.least.lo, least + 1e-15);
        ASSERT_GE(found.least.hi, least - 1e-15);
        collided += !colliding.empty();
        ASSERT_EQ(self.collides(values), !colliding.empty());
        balls.asked = 0;
        ASSERT_EQ(self.collides(values), !colliding.empty());
        if (!colliding.empty()) {
            ASSERT_EQ(balls.asked, 1u); // the pair that touched last comes first
        }
    }
    EXPECT_GT(collided, 100);
    EXPECT_LT(collided, 1900);
    EXPECT_LT(asked, 2000u * 66 / 4); // of 66 pairs; the gaps of boxes leave most out
}

TEST(RobotSelfCollision, WithoutPairsThereIsNoDistance) {
    const Robot robot = snake(2);
    const LinkBoxes boxes(robot, {});
    AllowedPairs allowed = no_allowed_pairs(robot);
    allow_adjacent(robot, allowed);
    const Balls balls(robot);
    RobotSelfCollision self(robot, boxes, allowed, balls);
    EXPECT_FALSE(self.check(robot.rest()).nearest);
    EXPECT_FALSE(self.collides(robot.rest()));
    EXPECT_THROW(self.check({}), std::invalid_argument);
    EXPECT_THROW(RobotSelfCollision(robot, boxes, AllowedPairs({"a"}), balls),
                 std::invalid_argument);
}

} // namespace
} // namespace boxwood
