#include "trees/world/bodies/robot_bodies.h"

#include "trees/testing/test_meshes.h"
#include "trees/world/bodies/robot_meshes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace boxwood {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

Pose at(double x, double y, double z) { return {Pose{}.rotation, {x, y, z}}; }

/// A base of a ball and a box above it, and on a rail along x a cube of 12 triangles.
Robot slider(double y = 3) {
    RobotDescription d;
    d.name = "slider";
    d.links = {{"base", {{LinkSphere{.5}, {}}, {LinkBox{{1, 1, 1}}, at(0, 0, 2)}}},
               {"cart", {{LinkMesh{0, {1, 1, 1}}, at(0, y, 0)}}}};
    JointDescription rail;
    rail.name = "rail";
    rail.kind = JointKind::prismatic;
    rail.parent = 0;
    rail.child = 1;
    rail.lower = -10;
    rail.upper = 10;
    d.joints = {rail};
    return Robot(std::move(d));
}
AllowedPairs none_allowed() { return AllowedPairs({"base", "cart"}); }

TEST(RobotBodies, MeetWhatIsAround) {
    const Robot robot = slider();
    const std::vector<TriangleMesh> meshes{cube_mesh(1)};
    World world;
    const std::uint32_t wall = world.insert(convex::Box{{1, 1, 1}}, at(6, 3, 0), {.name = "wall"});
    RobotBodies bodies(world, robot, meshes, none_allowed());
    ASSERT_EQ(bodies.bodies().size(), 3u);
    EXPECT_EQ(world.name(bodies.bodies()[0]), "base");
    EXPECT_EQ(world.name(bodies.bodies()[1]), "base#2");
    EXPECT_EQ(world.name(bodies.bodies()[2]), "cart");
    EXPECT_EQ(bodies.link_of(bodies.bodies()[1]), 0u);
    EXPECT_EQ(bodies.link_of(wall), std::nullopt);
    const std::uint32_t cart = world.find("cart");
    const double side = world.shape(cart).bounds().max.x; // of the cube, about its middle
    const double free = 5 - side;
    bodies.place(std::vector{free - .25});
    EXPECT_EQ(world.collisions(), std::vector<Pair>{});
    const auto least = world.least_distance_of(wall);
    ASSERT_TRUE(least);
    EXPECT_NEAR(least->distance, .25, 1e-12);
    bodies.place(std::vector{free + .25});
    EXPECT_THAT(world.collisions(), ElementsAre(Pair{wall, cart}));
    bodies.place(std::vector{free + .25}, at(0, 0, 9)); // the whole robot elsewhere
    EXPECT_EQ(world.collisions(), std::vector<Pair>{});
}

TEST(RobotBodies, AgreeWithTheRobotsOwnNarrowPhase) {
    const Robot robot = slider(.5);
    const std::vector<TriangleMesh> meshes{noisy_sphere(9, 8, .1, 1)};
    for (const bool are_solid : {false, true}) {
        const RobotMeshes own(robot, meshes, {.are_solid = are_solid});
        World world;
        RobotBodies bodies(world, robot, meshes, none_allowed(), {.are_solid = are_solid});
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> x(-2, 2);
        std::vector<RigidTransform<double>> poses(2);
        int hits = 0;
        for (int k = 0; k < 200; ++k) {
            const std::vector values{x(random)};
            const RigidTransform<double> root = at(x(random), x(random), x(random));
            bodies.place(values, root);
            robot.poses(values, poses, root);
            const bool expected = own.collide(0, 1, poses);
            hits += expected;
            EXPECT_EQ(!world.collisions().empty(), expected);
        }
        EXPECT_GT(hits, 50);
        EXPECT_LT(hits, 190);
    }
}

TEST(RobotBodies, MayMeetWhatIsAllowed) {
    const Robot robot = slider();
    const std::vector<TriangleMesh> meshes{cube_mesh(1)};
    AllowedPairs allowed = none_allowed();
    allowed.allow("base", "cart", AllowedReason::adjacent);
    World world;
    const RobotBodies one(world, robot, meshes, allowed, {.prefix = "left/"});
    const RobotBodies two(world, robot, meshes, allowed, {.prefix = "right/"});
    const auto id = [&](const char* name) { return world.find(name); };
    EXPECT_EQ(world.allowed(id("left/base"), id("left/base#2")), AllowedReason::always);
    EXPECT_EQ(world.allowed(id("left/base#2"), id("left/cart")), AllowedReason::adjacent);
    EXPECT_EQ(world.allowed(id("left/base"), id("right/base")), std::nullopt);
    EXPECT_EQ(world.collisions().size(), 3u); // each geometry and its like: both are at one place
}

TEST(RobotBodies, RefuseWhatDoesNotFitAndLeaveNothingBehind) {
    const Robot robot = slider();
    const std::vector<TriangleMesh> meshes{cube_mesh(1)};
    World world;
    EXPECT_THAT([&] { RobotBodies(world, robot, {}, none_allowed()); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("link cart names mesh 0")));
    EXPECT_EQ(world.size(), 0u);
    EXPECT_THAT([&] { RobotBodies(world, robot, meshes, AllowedPairs({"base"})); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("the robot has 2 links")));
    world.insert(convex::Sphere{1}, {}, {.name = "cart"});
    EXPECT_THROW(RobotBodies(world, robot, meshes, none_allowed()), std::invalid_argument);
    EXPECT_EQ(world.size(), 1u);
}

} // namespace
} // namespace boxwood
