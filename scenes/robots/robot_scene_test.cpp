#include "scenes/robots/robot_scene.h"

#include "scenes/human_name.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

namespace fs = std::filesystem;

/// Two boxes and a ball on two hinges.
constexpr const char* sliding_arm = R"(<robot name="arm">
<link name="base"><collision><geometry><box size="2 2 2"/></geometry></collision></link>
<link name="upper"><collision><origin xyz="1 0 0"/><geometry><box size="2 1 1"/></geometry></collision>
</link>
<link name="tip"><collision><geometry><sphere radius="0.5"/></geometry></collision></link>
<link name="eye"/>
<joint name="a" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 2"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="2" effort="1" velocity="1"/></joint>
<joint name="b" type="revolute"><parent link="upper"/><child link="tip"/><origin xyz="2 0 0"/>
<axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="c" type="fixed"><parent link="tip"/><child link="eye"/></joint>
</robot>)";

struct RobotScene : testing::Test {
    fs::path folder, urdf, srdf;
    void SetUp() override {
        std::string name = fs::path(testing::TempDir()) / "robot_scene_XXXXXX";
        ASSERT_TRUE(mkdtemp(name.data()));
        folder = name;
        urdf = folder / "robot_scene_arm.urdf";
        srdf = folder / "robot_scene_arm.srdf";
        std::ofstream(urdf) << sliding_arm;
    }
    void TearDown() override { fs::remove_all(folder); }
};

TEST_F(RobotScene, HoldsARobotInStatesAtRandom) {
    const SceneSpec spec{.generator = "robot", .n = 4, .file = urdf, .n_poses = 20};
    const Scene scene = make_scene(spec);
    EXPECT_EQ(scene.name, "robot_robot_scene_arm");
    EXPECT_EQ(human_name(spec), "robot robot_scene_arm, 20 states at random");
    ASSERT_TRUE(scene.robot);
    EXPECT_FALSE(scene.robot->allowed);
    ASSERT_EQ(scene.robot->states.size(), 20u);
    for (const auto& state : scene.robot->states) {
        ASSERT_EQ(state.size(), 2u);
        EXPECT_GE(state[0], -1);
        EXPECT_LE(state[0], 2);
        EXPECT_LE(std::abs(state[1]), 3);
    }
    ASSERT_EQ(scene.boxes.size(), 4u); // one per link
    EXPECT_EQ(scene.boxes[1], (Aabb<float>{{0, -.5f, -.5f}, {2, .5f, .5f}}));
    EXPECT_EQ(scene.boxes[2], (Aabb<float>{{-.5f, -.5f, -.5f}, {.5f, .5f, .5f}}));
    EXPECT_GT(scene.boxes[3].min.x, scene.boxes[3].max.x);
    SceneSpec other = spec;
    other.seed = 2;
    EXPECT_NE(make_scene(other).content_hash, scene.content_hash);
    EXPECT_EQ(make_scene(spec).content_hash, scene.content_hash);
}

TEST_F(RobotScene, MayGoAlongAWayBetweenStatesAtRandom) {
    const SceneSpec spec{
        .generator = "robot", .n = 4, .file = urdf, .poses = "along", .n_poses = 130};
    const Scene scene = make_scene(spec);
    EXPECT_EQ(scene.name, "robot_robot_scene_arm_along");
    EXPECT_EQ(human_name(spec), "robot robot_scene_arm, 130 states along a way");
    const auto& states = scene.robot->states;
    ASSERT_EQ(states.size(), 130u);
    const auto at_random = read_robot_states(urdf, 3, 1).states;
    EXPECT_EQ(states[0], at_random[0]);
    EXPECT_EQ(states[64], at_random[1]);
    EXPECT_EQ(states[128], at_random[2]);
    EXPECT_NEAR(states[96][0], (at_random[1][0] + at_random[2][0]) / 2, 1e-15);
    for (std::size_t i = 1; i < states.size(); ++i)
        for (std::size_t value = 0; value < 2; ++value)
            EXPECT_LE(std::abs(states[i][value] - states[i - 1][value]), 6. / 64);
    EXPECT_THROW(read_robot_states(urdf, 3, 1, "alongside"), std::invalid_argument);
}

TEST_F(RobotScene, TakesTheSrdfFileBesideIt) {
    std::ofstream(srdf) << "<robot name=\"arm\"><disable_collisions link1=\"base\" link2=\"tip\" "
                           "reason=\"Never\"/></robot>";
    const RobotStates robot = read_robot_states(urdf, 0, 1);
    ASSERT_TRUE(robot.allowed);
    ASSERT_EQ(robot.allowed->size(), 1u);
    EXPECT_EQ((*robot.allowed)[0].a, 0u);
    EXPECT_EQ((*robot.allowed)[0].b, 2u);
}

TEST_F(RobotScene, RefusesNoFileAndAMissingOne) {
    EXPECT_THROW(make_scene({.generator = "robot"}), std::invalid_argument);
    EXPECT_THROW(make_scene({.generator = "robot", .file = "no_such.urdf"}), std::runtime_error);
}

} // namespace
} // namespace boxwood
