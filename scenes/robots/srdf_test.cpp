#include "scenes/robots/srdf.h"

#include "scenes/robots/urdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

namespace boxwood {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using Reason = AllowedReason;

RobotDescription four_links() {
    RobotDescription robot{"four", {{"base"}, {"arm"}, {"hand"}, {"a & \"b\""}}};
    robot.joints = {{"turn", JointKind::continuous, 0, 1},
                    {"grip", JointKind::prismatic, 1, 2, {}, {1, 0, 0}, 0, 1},
                    {"tie", JointKind::fixed, 2, 3}};
    return robot;
}

const std::string srdf = R"(<?xml version="1.0"?>
<robot name="another name">
  <group name="all"><chain base_link="base" tip_link="hand"/></group>
  <group_state name="ready" group="all">
    <joint name="turn" value="-0.5"/><joint name="virtual" value="0 0 0"/>
    <joint name="grip" value="1"/>
  </group_state>
  <virtual_joint name="virtual" type="planar" parent_frame="world" child_link="base"/>
  <!-- kept -->
  <disable_collisions link1="hand" link2="arm" reason="Adjacent"/>
  <disable_collisions link1="base" link2="arm" reason="adjacent"/>
  <disable_collisions link1="base" link2="hand" reason="a cable hangs there"/>
  <disable_collisions link1="base" link2="a &amp; &quot;b&quot;" reason="Sampled: in none of 9"/>
  <disable_collisions link1="arm" link2="hand" reason="Default"/>
  <disable_collisions link1="arm" link2="a &amp; &quot;b&quot;"/>
</robot>
)";

TEST(SrdfFile, ReadsPairsWithTheirReasonsAndStates) {
    const Srdf found = parse_srdf(srdf, "r.srdf", four_links());
    EXPECT_THAT(found.allowed, ElementsAre(AllowedPair{0, 1, Reason::adjacent},
                                           AllowedPair{0, 2, Reason::user, "a cable hangs there"},
                                           AllowedPair{0, 3, Reason::sampled, "in none of 9"},
                                           AllowedPair{1, 2, Reason::default_state},
                                           AllowedPair{1, 3, Reason::user}));
    ASSERT_EQ(found.states.size(), 1u);
    EXPECT_EQ(found.states[0].name, "ready");
    EXPECT_EQ(found.states[0].group, "all");
    EXPECT_THAT(found.states[0].values, ElementsAre(Pair(0, -.5), Pair(1, 1.)));
}

TEST(SrdfFile, DefaultsAreDisabledFirstAndEnabledLast) {
    const Srdf found = parse_srdf(R"(<robot>
<enable_collisions link1="arm" link2="base"/><disable_default_collisions link="arm"/>
<disable_collisions link1="arm" link2="hand" reason="Never"/></robot>)",
                                  "r.srdf", four_links());
    EXPECT_THAT(found.allowed,
                ElementsAre(AllowedPair{1, 2, Reason::never},
                            AllowedPair{1, 3, Reason::user, "disable_default_collisions"}));
}

TEST(SrdfFile, WhatIsWrittenReadsTheSame) {
    std::vector<AllowedPair> pairs;
    std::uint32_t n = 0;
    for (std::uint32_t a = 0; a < 4; ++a)
        for (std::uint32_t b = a + 1; b < 4; ++b, ++n)
            pairs.push_back(
                {a, b, static_cast<Reason>(n % 6), n % 2 ? "Never: <&\"'> \xc3\xa9" : ""});
    const std::string text = srdf_text(four_links(), pairs);
    EXPECT_THAT(text, AllOf(HasSubstr("<robot name=\"four\">"), HasSubstr("reason=\"Adjacent\"")));
    EXPECT_EQ(parse_srdf(text, "w.srdf", four_links()).allowed, pairs);
    EXPECT_EQ(srdf_text(four_links(), pairs, text), text);
}

TEST(SrdfFile, WritingKeepsTheRestOfTheOriginal) {
    const std::vector<AllowedPair> pairs{{2, 3, Reason::always}};
    const std::string text = srdf_text(four_links(), pairs, srdf);
    EXPECT_THAT(text, AllOf(HasSubstr("another name"), HasSubstr("<!-- kept -->"),
                            HasSubstr("tip_link=\"hand\""), HasSubstr("virtual_joint")));
    const Srdf found = parse_srdf(text, "w.srdf", four_links());
    EXPECT_EQ(found.allowed, pairs);
    EXPECT_EQ(found.states.size(), 1u);
}

TEST(SrdfFile, ErrorsNameTheLineAndTheWayOut) {
    const auto complaint = [](const std::string& inner) -> std::string {
        try {
            parse_srdf("<robot>\n" + inner + "</robot>", "r.srdf", four_links());
            return "accepted";
        } catch (const std::runtime_error& error) {
            return error.what();
        }
    };
    EXPECT_EQ(complaint(""), "accepted");
    for (const char* name : {"link", "joint"})
        EXPECT_THAT(complaint(std::string("<") + name + " name='base'/>"),
                    HasSubstr(std::string("r.srdf:2: a <") + name +
                              "> of the robot: this is a URDF file; name the SRDF file"));
    EXPECT_THAT(complaint("<disable_collisions link1='bas' link2='arm'/>"),
                AllOf(HasSubstr("r.srdf:2: <disable_collisions link1=...>"),
                      HasSubstr("unknown link of the robot 'bas'; did you mean 'base'")));
    EXPECT_THAT(complaint("\n<disable_collisions link1='base'/>"),
                HasSubstr("r.srdf:3: <disable_collisions> needs an attribute link2"));
    EXPECT_THAT(complaint("<disable_collisions link1='base' link2='base'/>"),
                HasSubstr("both 'base'"));
    EXPECT_THAT(complaint("<group_state name='s'><joint name='trun' value='0'/></group_state>"),
                HasSubstr("did you mean 'turn'"));
    EXPECT_THAT(complaint("<group_state name='s'><joint name='turn' value='nan'/></group_state>"),
                HasSubstr("not finite"));
    EXPECT_THAT(complaint("<group_state><joint name='turn'/></group_state>"),
                HasSubstr("needs an attribute name"));
    for (const std::string text :
         {"<robot/>\n<robot/>", "<robot/>\ntext<!-- c -->", "<robot/>x</a>"})
        EXPECT_THROW(parse_srdf(text, "r", four_links()), std::runtime_error) << text;
    EXPECT_EQ(parse_srdf("<?xml?><!-- a --><robot/><!-- b -->", "r", four_links()).allowed.size(),
              0u);
    EXPECT_THROW(parse_srdf("<robot>", "r", four_links()), std::runtime_error);
    EXPECT_THROW(read_srdf("/nonexistent.srdf", four_links()), std::runtime_error);
    EXPECT_THROW(srdf_text(four_links(), {}, "<sdf/>"), std::runtime_error);
}

TEST(SrdfFile, DamagedFilesAreReadOrRefused) {
    for (std::size_t size = 0; size < srdf.size(); ++size)
        try {
            parse_srdf(srdf.substr(0, size), "r.srdf", four_links());
        } catch (const std::runtime_error&) {
        }
}

TEST(SharedRobots, SrdfFilesLoadAndComeBackTheSame) {
    const fs::path robots = "../shared/data/robots";
    if (!fs::is_directory(robots))
        GTEST_SKIP() << robots << " is not here: the sample robots are no part of the project";
    for (const std::string name : {"panda", "z1"}) {
        const RobotDescription robot = read_urdf(robots / name / (name + ".urdf")).description;
        const Srdf found = read_srdf(robots / name / (name + ".srdf"), robot);
        std::map<Reason, int> reasons;
        for (const AllowedPair& pair : found.allowed)
            ++reasons[pair.reason];
        if (name == "panda")
            EXPECT_THAT(reasons, ElementsAre(Pair(Reason::adjacent, 10), Pair(Reason::never, 23),
                                             Pair(Reason::default_state, 1)));
        else
            EXPECT_TRUE(reasons.empty());
        EXPECT_EQ(found.states.size(), name == "panda" ? 5u : 2u);
        EXPECT_EQ(parse_srdf(srdf_text(robot, found.allowed), "w", robot).allowed, found.allowed);
        std::ifstream in(robots / name / (name + ".srdf"));
        std::stringstream original;
        original << in.rdbuf();
        const Srdf again = parse_srdf(srdf_text(robot, found.allowed, original.str()), "w", robot);
        EXPECT_EQ(again.allowed, found.allowed);
        EXPECT_EQ(again.states.size(), found.states.size());
    }
}

} // namespace
} // namespace boxwood
