#include "scenes/robots/urdf.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

namespace boxwood {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::string_view triangle_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A robot of our own with every kind of joint and shape that is read.
const std::string arm = R"(<?xml version="1.0"?>
<!-- comment -->
<robot name="our arm">
  <material name="grey"/>
  <link name="tool &amp; tip">
    <collision><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <link name="base">
    <visual><geometry><mesh filename="nowhere.dae"/></geometry></visual>
    <collision name="first">
      <origin xyz="1	2
 3" rpy="0 0 1.5707963267948966"/>
      <geometry><box size="1 2 +.5"/></geometry>
    </collision>
    <collision><geometry><cylinder radius=".1" length="1e-1"/></geometry></collision>
    <inertial><mass value="heavy"/></inertial>
  </link>
  <link name="upper"><collision><geometry><capsule radius="0.1" length="0.4"/></geometry></collision></link>
  <link name="slide"/>
  <link name="twin"/>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="upper"/><axis xyz="0 0 2"/><dynamics damping="much"/>
  </joint>
  <joint name="tool joint" type="fixed">
    <parent link="slide"/><child link="tool &amp; tip"/><axis xyz="0 0 0"/><origin xyz="0 0 1"/>
  </joint>
  <joint name="push" type="prismatic">
    <parent link="upper"/><child link="slide"/><limit effort="1" velocity="1" upper="0.5"/>
  </joint>
  <joint name="push back" type="revolute">
    <parent link="upper"/><child link="twin"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1"/><mimic joint="push" multiplier="-2" offset=".5"/>
    <origin rpy="0.1 0.2 0.3" xyz="0 0 0"/>
  </joint>
  <transmission name="t"><joint name="turn"><hardwareInterface/></joint></transmission>
  <gazebo reference="base"><self_collide>true</self_collide></gazebo>
</robot>
)";

std::string changed(std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(Urdf, ReadsLinksJointsAndShapesInTheOrderOfTheFile) {
    const RobotDescription robot = parse_urdf(arm, "arm.urdf").description;
    EXPECT_EQ(robot.name, "our arm");
    ASSERT_EQ(robot.links.size(), 5u);
    EXPECT_EQ(robot.links[0].name, "tool & tip");
    EXPECT_EQ(robot.links[4].name, "twin");
    const auto& base = robot.links[1].geometries;
    ASSERT_EQ(base.size(), 2u);
    EXPECT_EQ(base[0].shape, (LinkShape{LinkBox{{1, 2, .5}}}));
    EXPECT_EQ(base[0].origin.translation, (Vec3<double>{1, 2, 3}));
    const Vec3<double> turned = base[0].origin({1, 0, 0}) - Vec3<double>{1, 3, 3};
    EXPECT_LT(length(turned), 1e-15);
    EXPECT_EQ(base[1].shape, (LinkShape{LinkCylinder{.1, .1}}));
    EXPECT_EQ(base[1].origin, RigidTransform<double>{});
    EXPECT_EQ(robot.links[2].geometries[0].shape, (LinkShape{LinkCapsule{.1, .4}}));
    EXPECT_EQ(robot.links[0].geometries[0].shape, (LinkShape{LinkSphere{.05}}));
    EXPECT_TRUE(robot.links[3].geometries.empty());

    ASSERT_EQ(robot.joints.size(), 4u);
    const auto& [turn, tool, push, back] =
        std::tie(robot.joints[0], robot.joints[1], robot.joints[2], robot.joints[3]);
    EXPECT_EQ(turn.kind, JointKind::continuous);
    EXPECT_EQ(turn.axis, (Vec3<double>{0, 0, 2}));
    EXPECT_EQ(tool.kind, JointKind::fixed);
    EXPECT_EQ(tool.origin.translation, (Vec3<double>{0, 0, 1}));
    EXPECT_EQ(push.kind, JointKind::prismatic);
    EXPECT_EQ(push.axis, (Vec3<double>{1, 0, 0})); // the default
    EXPECT_EQ(push.lower, 0);
    EXPECT_EQ(push.upper, .5);
    EXPECT_EQ(push.parent, 2u);
    EXPECT_EQ(push.child, 3u);
    ASSERT_TRUE(back.mimic);
    EXPECT_EQ(back.mimic->joint, 2u);
    EXPECT_EQ(back.mimic->multiplier, -2);
    EXPECT_EQ(back.mimic->offset, .5);
}

// Roll, then pitch, then yaw, about axes that stand still: R = Rz(yaw) Ry(pitch) Rx(roll).
TEST(Urdf, AnglesOfAnOriginAreRollPitchYaw) {
    const RobotDescription robot = parse_urdf(arm, "arm.urdf").description;
    const auto turn = [](int axis, long double angle, std::array<long double, 3> v) {
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        const long double c = std::cos(angle), s = std::sin(angle);
        const auto x = v[static_cast<std::size_t>(i)], y = v[static_cast<std::size_t>(j)];
        v[static_cast<std::size_t>(i)] = c * x - s * y;
        v[static_cast<std::size_t>(j)] = s * x + c * y;
        return v;
    };
    for (const Vec3<double> p : {Vec3<double>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
        const auto q = turn(2, .3L, turn(1, .2L, turn(0, .1L, {p.x, p.y, p.z})));
        const Vec3<double> found = robot.joints[3].origin(p);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(static_cast<double>(q[static_cast<std::size_t>(axis)]), found[axis], 1e-15);
    }
}

std::string complaint(const std::string& text) {
    try {
        parse_urdf(text, "arm.urdf");
        return "accepted";
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

TEST(Urdf, NoXmlOrNoRobotIsRefused) {
    EXPECT_THAT(complaint(""), HasSubstr("arm.urdf: it is empty"));
    EXPECT_THAT(complaint(" \n"), HasSubstr("it is empty"));
    EXPECT_THAT(complaint("<!-- c -->"), HasSubstr("no element"));
    EXPECT_THAT(complaint("<robot><link name='a'>\n</robot>"),
                AllOf(StartsWith("arm.urdf:"), HasSubstr("no well-formed XML")));
    EXPECT_THAT(complaint("hello"), HasSubstr("no well-formed XML"));
    EXPECT_THAT(complaint(std::string("<robot/>\0", 9)), HasSubstr("zero byte"));
    EXPECT_THAT(complaint("\n<sdf/>"), HasSubstr("arm.urdf:2: the root element is <sdf>"));
    EXPECT_THAT(complaint("<robot/>"), HasSubstr("no <link>"));
    EXPECT_THAT(complaint("<robot>\n<xacro:include filename='x'/></robot>"),
                HasSubstr("arm.urdf:2: <xacro:include> is xacro"));
}

TEST(Urdf, ErrorsNameTheLineAndTheWayOut) {
    const auto with = [](std::string_view from, std::string_view to) {
        return complaint(changed(arm, from, to));
    };
    EXPECT_THAT(with("<link name=\"slide\"/>", "<link/>"),
                HasSubstr("arm.urdf:19: <link> needs an attribute name"));
    EXPECT_THAT(with("<link name=\"slide\"/>", "<link name=\"base\"/>"),
                HasSubstr("arm.urdf:19: a second <link name=\"base\">; the first is in line 8"));
    EXPECT_THAT(with("name=\"push back\"", "name=\"push\""), HasSubstr("a second <joint"));
    EXPECT_THAT(with("<parent link=\"base\"/>", "<parent link=\"basis\"/>"),
                AllOf(HasSubstr("arm.urdf:22: <parent link=...>: unknown link 'basis'"),
                      HasSubstr("did you mean 'base'")));
    EXPECT_THAT(with("<child link=\"slide\"/>", ""), HasSubstr("needs an element <child>"));
    EXPECT_THAT(with("type=\"continuous\"", "type=\"floating\""),
                AllOf(HasSubstr("arm.urdf:21: joint 'turn' is floating, which is not supported"),
                      HasSubstr("6 values")));
    EXPECT_THAT(with("type=\"continuous\"", "type=\"planar\""), HasSubstr("3 values"));
    EXPECT_THAT(with("type=\"continuous\"", "type=\"continous\""),
                HasSubstr("did you mean 'continuous'"));
    EXPECT_THAT(with("type=\"continuous\"", "type=\"revolute\""),
                AllOf(HasSubstr("arm.urdf:21: joint 'turn' is revolute and has no limits"),
                      HasSubstr("or make it continuous")));
    EXPECT_THAT(with("<limit lower=\"-1\" upper=\"1\"/>", "<limit lower=\"2\" upper=\"1\"/>"),
                HasSubstr("joint 'push back': its lower limit 2 is above the upper one, 1"));
    EXPECT_THAT(with("lower=\"-1\"", "lower=\"nan\""), HasSubstr("'nan' is not finite"));
    EXPECT_THAT(with("axis xyz=\"0 0 2\"", "axis xyz=\"0 0 0\""), HasSubstr("no direction"));
    EXPECT_THAT(with("axis xyz=\"0 0 2\"", "axis xyz=\"0 0\""), HasSubstr("'0 0' is not three"));
    EXPECT_THAT(with("axis xyz=\"0 0 2\"", "axis xyz=\"0 0 1e999\""),
                HasSubstr("beyond the range"));
    EXPECT_THAT(with("axis xyz=\"0 0 2\"", "axis xyz=\"0 0 2m\""), HasSubstr("'2m' is no number"));
    EXPECT_THAT(with("axis xyz=\"0 0 2\"", "axis xyz=\"0 0 0x2\""),
                HasSubstr("'0x2' is no number"));
    EXPECT_THAT(with("axis xyz=\"0 0 2\"", "axis xyz=\"0 0 +-2\""),
                HasSubstr("'+-2' is no number"));
    EXPECT_THAT(with("radius=\"0.05\"", "radius=\"-0.05\""),
                HasSubstr("arm.urdf:6: <sphere radius=\"-0.05\">: it must not be negative"));
    EXPECT_THAT(with("radius=\"0.05\"", ""), HasSubstr("<sphere> needs an attribute radius"));
    EXPECT_THAT(with("radius=\"0.05\"", "radius=\"1 2\""), HasSubstr("more than one number"));
    EXPECT_THAT(with("size=\"1 2 +.5\"", "size=\"1 -2 1\""), HasSubstr("must not be negative"));
    EXPECT_THAT(with("size=\"1 2 +.5\"", "size=\"1 2 1e300\""),
                HasSubstr("<box size=...>: 1e+300 is beyond 2^60"));
    EXPECT_THAT(with("radius=\"0.05\"", "radius=\"1e19\""),
                HasSubstr("arm.urdf:6: <sphere radius=...>: 1e+19 is beyond 2^60"));
    EXPECT_THAT(with("<sphere radius=\"0.05\"/>", ""), HasSubstr("<geometry> needs one shape"));
    EXPECT_THAT(with("<sphere radius=\"0.05\"/>", "<sphre radius=\"1\"/>"),
                HasSubstr("did you mean 'sphere'"));
    EXPECT_THAT(with("<geometry><sphere radius=\"0.05\"/></geometry>", ""),
                HasSubstr("<collision> needs an element <geometry>"));
    EXPECT_THAT(with("mimic joint=\"push\"", "mimic joint=\"puhs\""),
                HasSubstr("did you mean 'push'"));
    EXPECT_THAT(with("mimic joint=\"push\"", "mimic joint=\"push back\""),
                HasSubstr("mimics itself"));
    EXPECT_THAT(with("mimic joint=\"push\"", "mimic joint=\"tool joint\""),
                HasSubstr("which is fixed"));
}

TEST(Urdf, LinksMustMakeATree) {
    EXPECT_THAT(complaint(changed(arm, "<child link=\"twin\"/>", "<child link=\"base\"/>")),
                AllOf(StartsWith("arm.urdf: "), HasSubstr("cycle")));
    EXPECT_THAT(complaint(changed(arm, "<child link=\"twin\"/>", "<child link=\"slide\"/>")),
                HasSubstr("link 'slide' hangs on two joints, 'push' and 'push back'"));
    EXPECT_THAT(complaint(changed(arm, "<link name=\"slide\"/>",
                                  "<link name=\"slide\"/><link name=\"loose\"/>")),
                HasSubstr("two roots: neither link 'base' nor link 'loose'"));
    EXPECT_THAT(complaint(changed(arm, "<parent link=\"upper\"/><child link=\"twin\"/>",
                                  "<parent link=\"twin\"/><child link=\"twin\"/>")),
                HasSubstr("to itself"));
}

TEST(Urdf, DeepAndLongFilesDoNotOverflowTheStack) {
    std::string deep = "<robot>";
    for (int i = 0; i < 100000; ++i)
        deep += "<a>";
    EXPECT_THAT(complaint(deep), HasSubstr("no well-formed XML: element depth exceeded"));
    std::string chain = "<robot><link name='0'/>";
    for (int i = 1; i < 20000; ++i)
        chain += fmt::format("<link name='{0}'/><joint name='{0}' type='fixed'><parent "
                             "link='{1}'/><child link='{0}'/></joint>",
                             i, i - 1);
    EXPECT_EQ(complaint(chain + "</robot>"), "accepted");
}

TEST(Urdf, DamagedFilesAreReadOrRefused) {
    int refused = 0;
    for (std::size_t size = 0; size < arm.size(); size += 3)
        refused += complaint(arm.substr(0, size)) != "accepted";
    EXPECT_GT(refused, 500);
    std::mt19937 random(1);
    for (int i = 0; i < 3000; ++i) {
        std::string text = arm;
        for (std::uint32_t k = 0; k < 1 + random() % 4; ++k) {
            const std::size_t at = random() % text.size(), from = random() % text.size();
            if (random() % 2)
                text[at] = "<>/\"=- 0019naife\0\xff&;"[random() % 21];
            else
                text.replace(at, random() % 40, text.substr(from, random() % 40));
        }
        complaint(text); // throws nothing else
    }
}

/// Files in a folder of their own.
class UrdfFiles : public ::testing::Test {
  protected:
    UrdfFiles()
        : folder_(fs::temp_directory_path() /
                  ("boxwood_urdf_" + std::to_string(std::random_device{}()))) {
        fs::create_directories(folder_);
    }
    ~UrdfFiles() override { fs::remove_all(folder_); }

    fs::path put(const fs::path& name, std::string_view text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    /// A robot of one link with these meshes.
    fs::path robot(const fs::path& name, const std::vector<std::string>& meshes) const {
        std::string text = "<robot name=\"r\">\n<link name=\"a\">\n";
        for (const std::string& mesh : meshes)
            text +=
                "<collision><geometry><mesh filename=\"" + mesh + "\"/></geometry></collision>\n";
        return put(name, text + "</link></robot>");
    }
    static std::string error(const fs::path& file, const std::vector<fs::path>& packages = {}) {
        try {
            read_urdf(file, packages);
            return "accepted";
        } catch (const std::runtime_error& error) {
            return error.what();
        }
    }
    fs::path folder_;
};

TEST_F(UrdfFiles, MeshesAreReadOnceEach) {
    put("meshes/a.obj", triangle_obj);
    put("meshes/b.obj", triangle_obj);
    put("c d.obj", triangle_obj);
    const fs::path file =
        robot("r.urdf", {"meshes/a.obj", "./meshes/../meshes/b.obj", "meshes/b.obj",
                         "file://" + (folder_ / "c%20d.obj").string()});
    const UrdfRobot found = read_urdf(file);
    EXPECT_THAT(found.mesh_files, ElementsAre(folder_ / "meshes/a.obj", folder_ / "meshes/b.obj",
                                              folder_ / "c d.obj"));
    ASSERT_EQ(found.meshes.size(), 3u);
    EXPECT_EQ(found.meshes[2].triangles.size(), 1u);
    std::vector<std::uint32_t> indices;
    for (const LinkGeometry& geometry : found.description.links[0].geometries)
        indices.push_back(std::get<LinkMesh>(geometry.shape).mesh);
    EXPECT_THAT(indices, ElementsAre(0, 1, 1, 2));
}

TEST_F(UrdfFiles, PackagesAreLookedForUpwards) {
    put("arm_description/meshes/in.obj", triangle_obj);
    put("other/meshes/beside.obj", triangle_obj);
    const fs::path file =
        robot("arm_description/urdf/r.urdf",
              {"package://arm_description/meshes/in.obj", "package://other/meshes/beside.obj",
               "package://renamed/robots/arm/meshes/in.obj"});
    EXPECT_THAT(read_urdf(file).mesh_files, ElementsAre(folder_ / "arm_description/meshes/in.obj",
                                                        folder_ / "other/meshes/beside.obj"));
    EXPECT_THAT(error(robot("x/r.urdf", {"package://nowhere/meshes/in.obj"})),
                AllOf(HasSubstr("r.urdf:3: link 'a': mesh package://nowhere/meshes/in.obj is not"),
                      HasSubstr((folder_ / "x/nowhere/meshes/in.obj").string()),
                      HasSubstr("--package-path")));
}

TEST_F(UrdfFiles, GivenPackageFoldersAloneAreSearched) {
    put("here/pack/meshes/a.obj", triangle_obj);
    put("there/pack/meshes/b.obj", triangle_obj);
    const fs::path b = robot("here/pack/r.urdf", {"package://pack/meshes/b.obj"});
    const fs::path a = robot("here/pack/s.urdf", {"package://pack/meshes/a.obj"});
    const fs::path there = folder_ / "there";
    EXPECT_THAT(read_urdf(b, std::vector{there}).mesh_files,
                ElementsAre(there / "pack/meshes/b.obj"));
    EXPECT_THAT(read_urdf(b, std::vector{folder_, there / "pack/"}).mesh_files,
                ElementsAre(there / "pack/meshes/b.obj"));
    EXPECT_THAT(error(a, {there}), HasSubstr("is not at"));
    EXPECT_EQ(error(a), "accepted");
}

TEST_F(UrdfFiles, WhatIsNotThereIsNamed) {
    EXPECT_THAT(error(folder_ / "none.urdf"), HasSubstr("none.urdf: no such file"));
    EXPECT_THAT(error(folder_), HasSubstr("is a folder"));
    EXPECT_THAT(error(robot("r.urdf", {"gone.stl"})),
                AllOf(HasSubstr("r.urdf:3: link 'a': mesh"), HasSubstr("gone.stl is not there")));
    EXPECT_THAT(error(robot("r.urdf", {"http://x/y.stl"})), HasSubstr("fetch the file"));
    EXPECT_THAT(error(robot("r.urdf", {"package://only"})), HasSubstr("package://PACKAGE/PATH"));
    put("bad.obj", "v 0 0 nan\n");
    EXPECT_THAT(
        error(robot("r.urdf", {"bad.obj"})),
        AllOf(HasSubstr("r.urdf:3: link 'a': mesh"), HasSubstr("bad.obj"), HasSubstr("line 1")));
}

} // namespace
} // namespace boxwood
