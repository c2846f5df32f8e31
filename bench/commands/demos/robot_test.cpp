#include "bench/commands/demos/demo.h"

#include "bench/io/bad_input.h"
#include "trees/world/bodies/robot_meshes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

/// Four cubes of side .5 in a row, one apart; the last one slides back to the first.
const std::string cubes = R"(<robot name="cubes">
<link name="a"><collision><geometry><box size=".5 .5 .5"/></geometry></collision></link>
<link name="b"><collision><geometry><box size=".5 .5 .5"/></geometry></collision></link>
<link name="c"><collision><geometry><box size=".5 .5 .5"/></geometry></collision></link>
<link name="d"><collision><geometry><box size=".5 .5 .5"/></geometry></collision></link>
<joint name="ab" type="fixed"><parent link="a"/><child link="b"/><origin xyz="1 0 0"/></joint>
<joint name="bc" type="fixed"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/></joint>
<joint name="cd" type="prismatic"><parent link="c"/><child link="d"/><origin xyz="1 0 0"/>
<axis xyz="1 0 0"/><limit lower="-3" upper="0"/></joint>
</robot>)";

class RobotDemoTest : public ::testing::Test {
  protected:
    RobotDemoTest()
        : folder_(fs::temp_directory_path() /
                  ("boxwood_robot_demo_" + std::to_string(std::random_device{}()))) {
        fs::create_directories(folder_);
    }
    ~RobotDemoTest() override { fs::remove_all(folder_); }

    std::string put(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    static std::string text_of(const RobotDemo& demo) {
        return robot_demo(
            demo, [](const Robot& robot, std::span<const TriangleMesh> meshes, bool are_solid) {
                return std::make_unique<RobotMeshes>(robot, meshes, RobotMeshesOptions{are_solid});
            });
    }
    fs::path folder_;
};

TEST_F(RobotDemoTest, GoesFromTheBoxesToWhatTouches) {
    const std::string text = text_of({{put("cubes.urdf", cubes), std::nullopt, {}}, 1});
    EXPECT_THAT(text, HasSubstr("Links: 4; with geometry for collisions: 4; values of joints: 1."));
    EXPECT_THAT(text, HasSubstr("4 x 3 / 2 = 6 box tests"));
    EXPECT_THAT(text, ContainsRegex("├── \\{a, b\\} +x"));
    EXPECT_THAT(text, HasSubstr("3 adjacent, as there is no --srdf"));
    // At rest nothing overlaps; the nearest that count are two apart, less the cubes.
    EXPECT_THAT(text, HasSubstr("Pairs that overlap: 0; of them allowed: 0; left: 0:\n   none."));
    EXPECT_THAT(text, ContainsRegex("the nearest: (a and c|b and d), 1.5000"));
    EXPECT_THAT(text, HasSubstr("the first in which links collide: cd=-"));
    EXPECT_THAT(text, ContainsRegex("[ab] and d: boxes overlap; the links TOUCH"));
    EXPECT_THAT(text, ContainsRegex("3 of 7 nodes changed, bottom-up: d, "));
}

TEST_F(RobotDemoTest, TakesAllowedPairsFromAnSrdfFile) {
    const std::string srdf =
        put("cubes.srdf", "<robot><disable_collisions link1='a' link2='d' reason='Never'/>"
                          "<disable_collisions link1='b' link2='d' reason='Never'/>"
                          "<disable_collisions link1='c' link2='d' reason='Adjacent'/></robot>");
    const std::string text = text_of({{put("cubes.urdf", cubes), srdf, {}}, 1});
    EXPECT_THAT(text, HasSubstr("1 adjacent, 2 never, as the SRDF file says"));
    EXPECT_THAT(text, HasSubstr("none of 1,000 collides"));
}

TEST_F(RobotDemoTest, RefusesWhatHasNoPairs) {
    const std::string one = put("one.urdf", "<robot name='one'><link name='a'/></robot>");
    EXPECT_THROW(text_of({{one, std::nullopt, {}}, 1}), BadInput);
    EXPECT_THROW(text_of({{"no_such_file.urdf", std::nullopt, {}}, 1}), BadInput);
}

} // namespace
} // namespace boxwood::bench
