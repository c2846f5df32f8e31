#include "kernels/kinematics/kinematic_tree.h"

#include "kernels/primitives/rotation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <stdexcept>

namespace boxwood {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Rigid motions by unit quaternions in long double: the oracle shares no formula with the code.
struct Quaternion {
    long double w, x, y, z;
};
struct Motion {
    Quaternion turn{1, 0, 0, 0};
    long double x = 0, y = 0, z = 0;
};
Quaternion operator*(Quaternion a, Quaternion b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
Motion operator*(const Motion& a, const Motion& b) {
    const Quaternion p = a.turn * Quaternion{0, b.x, b.y, b.z} *
                         Quaternion{a.turn.w, -a.turn.x, -a.turn.y, -a.turn.z};
    return {a.turn * b.turn, a.x + p.x, a.y + p.y, a.z + p.z};
}
Motion turn_about(Vec3<double> axis, double angle) {
    const long double x = axis.x, y = axis.y, z = axis.z,
                      half = static_cast<long double>(angle) / 2;
    const long double s = std::sin(half) / std::sqrt(x * x + y * y + z * z);
    return {{std::cos(half), s * x, s * y, s * z}};
}
Motion shift(Vec3<double> by) { return {{1, 0, 0, 0}, by.x, by.y, by.z}; }

/// How far apart the images of the unit vectors are.
double difference(const Motion& expected, const RigidTransform<double>& found) {
    long double largest = 0;
    for (const Vec3<double> p : {Vec3<double>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}) {
        const Motion image = expected * shift(p);
        const Vec3<double> at = found(p);
        largest = std::max({largest, std::abs(image.x - at.x), std::abs(image.y - at.y),
                            std::abs(image.z - at.z)});
    }
    return static_cast<double>(largest);
}

/// A random tree of joints, and beside each joint its origin as the oracle has it.
struct RandomRobot {
    explicit RandomRobot(std::uint64_t seed, std::uint32_t n_links, bool chain = false)
        : bits(seed) {
        std::vector<std::uint32_t> names(n_links); // so that the order of links says nothing
        for (std::uint32_t i = 0; i < n_links; ++i)
            names[i] = i;
        std::shuffle(names.begin(), names.end(), bits);
        for (std::uint32_t i = 0; i < n_links; ++i)
            robot.links.push_back({"link" + std::to_string(i)});
        for (std::uint32_t i = 1; i < n_links; ++i) {
            JointDescription joint{"joint" + std::to_string(i)};
            joint.kind = static_cast<JointKind>(bits() % 4);
            joint.parent = names[chain ? i - 1 : bits() % i];
            joint.child = names[i];
            joint.axis = {real(-3, 3), real(-3, 3), real(-3, 3)};
            joint.lower = real(-2, 0);
            joint.upper = real(0, 2);
            const Vec3<double> about{real(-1, 1), real(-1, 1), real(.1, 1)}, by{real(-1, 1), 0, 1};
            const double angle = real(-4, 4);
            joint.origin = {rotation_about(about * (1 / length(about)), angle), by};
            Motion turned = turn_about(about, angle);
            if (bits() % 3 == 0) { // axes parallel to the parent's
                joint.origin.rotation = RigidTransform<double>{}.rotation;
                turned = {};
            }
            robot.joints.push_back(joint);
            origins.push_back(shift(by) * turned);
        }
        // In any order, each joint beside its origin.
        for (std::size_t i = robot.joints.size(); i-- > 1;) {
            const std::size_t k = bits() % (i + 1);
            std::swap(robot.joints[i], robot.joints[k]);
            std::swap(origins[i], origins[k]);
        }
    }
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(bits);
    }

    /// From the link up to the root.
    Motion pose(std::uint32_t link, const std::vector<double>& joint_values) const {
        for (std::size_t j = 0; j < robot.joints.size(); ++j) {
            const JointDescription& joint = robot.joints[j];
            if (joint.child != link)
                continue;
            Motion moved;
            if (joint.kind == JointKind::prismatic) {
                const double by = joint_values[j] / length(joint.axis);
                moved = shift(by * joint.axis);
            } else if (joint.kind != JointKind::fixed) {
                moved = turn_about(joint.axis, joint_values[j]);
            }
            return pose(joint.parent, joint_values) * origins[j] * moved;
        }
        return {};
    }

    std::mt19937_64 bits;
    RobotDescription robot;
    std::vector<Motion> origins;
};

TEST(KinematicTree, PosesAgreeWithQuaternionsInLongDouble) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        RandomRobot random(seed, 2 + static_cast<std::uint32_t>(seed % 30));
        const KinematicTree tree(random.robot);
        std::vector<double> values(tree.n_values()), of_joints(random.robot.joints.size());
        for (std::size_t k = 0; k < values.size(); ++k)
            of_joints[tree.joints_of_values()[k]] = values[k] = random.real(-7, 7);
        std::vector<RigidTransform<double>> poses(tree.n_links());
        tree.forward(values, poses);
        for (std::uint32_t link = 0; link < tree.n_links(); ++link)
            ASSERT_LT(difference(random.pose(link, of_joints), poses[link]), 1e-13)
                << "seed " << seed << ", link " << link;
    }
}

TEST(KinematicTree, RotationsStayOrthonormalHoweverLongTheChain) {
    RandomRobot random(5, 3000, true);
    const KinematicTree tree(random.robot);
    std::vector<double> values(tree.n_values());
    for (double& value : values)
        value = random.real(-3, 3);
    std::vector<RigidTransform<double>> poses(tree.n_links());
    tree.forward(values, poses);
    for (const RigidTransform<double>& pose : poses)
        ASSERT_LE(distance_from_orthonormal(pose.rotation), 16 * 0x1p-53);
}

TEST(KinematicTree, WholeTurnsAndRightAnglesOfTheBoxStayExact) {
    RobotDescription robot{"r", {{"a"}, {"b"}, {"c"}}};
    robot.joints = {
        {"b", JointKind::fixed, 0, 1, {{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}, {1, 2, 3}}},
        {"c", JointKind::revolute, 1, 2, {.translation = {.5, 0, 0}}, {0, 0, 2}, -1, 1}};
    const KinematicTree tree(robot);
    EXPECT_EQ(tree.n_values(), 1u);
    std::vector<RigidTransform<double>> poses(3);
    tree.forward(std::vector{0.0}, poses);
    EXPECT_EQ(poses[0], RigidTransform<double>{});
    EXPECT_EQ(poses[1], robot.joints[0].origin);
    EXPECT_EQ(poses[2].rotation, robot.joints[0].origin.rotation);
    EXPECT_EQ(poses[2].translation, (Vec3<double>{1, 2.5, 3}));
    const RigidTransform<double> elsewhere{poses[1].rotation, {10, 0, 0}};
    tree.forward(std::vector{0.0}, poses, elsewhere);
    EXPECT_EQ(poses[0], elsewhere);
    EXPECT_EQ(poses[1].translation, (Vec3<double>{8, 1, 3}));
}

/// base - slide (prismatic) - follower, which mimics it - second, which mimics that.
RobotDescription gripper() {
    RobotDescription robot{"gripper", {{"base"}, {"left"}, {"right"}, {"third"}}};
    robot.joints = {
        {"second", JointKind::prismatic, 0, 3, {}, {0, 0, 1}, -1, 1, Mimic{1, 3, 1}},
        {"follower", JointKind::prismatic, 0, 2, {}, {0, -1, 0}, 0, 1, Mimic{2, 2, .25}},
        {"slide", JointKind::prismatic, 0, 1, {}, {0, 5, 0}, 0, .5}};
    return robot;
}

TEST(KinematicTree, MimicJointsFollow) {
    const KinematicTree tree(gripper());
    ASSERT_THAT(tree.joints_of_values(), ElementsAre(2));
    EXPECT_EQ(tree.ranges()[0].upper, .5);
    std::vector<RigidTransform<double>> poses(4);
    tree.forward(std::vector{.125}, poses);
    EXPECT_EQ(poses[1].translation, (Vec3<double>{0, .125, 0}));
    EXPECT_EQ(poses[2].translation, (Vec3<double>{0, -.5, 0}));
    EXPECT_EQ(poses[3].translation, (Vec3<double>{0, 0, 2.5})); // 3 (2 * .125 + .25) + 1
}

TEST(KinematicTree, KnowsParentsAndWhatFixedJointsMakeOne) {
    RobotDescription robot{"r", {{"tip"}, {"flange"}, {"base"}, {"arm"}, {"tool"}}};
    robot.joints = {{"j0", JointKind::fixed, 1, 0},
                    {"j1", JointKind::fixed, 3, 1},
                    {"j2", JointKind::continuous, 2, 3},
                    {"j3", JointKind::fixed, 1, 4}};
    const KinematicTree tree(robot);
    EXPECT_EQ(tree.root(), 2u);
    EXPECT_THAT(tree.parents(), ElementsAre(1, 3, 2, 2, 1));
    EXPECT_THAT(tree.rigid_parts(), ElementsAre(3, 3, 2, 3, 3));
    EXPECT_TRUE(tree.ranges()[0].wraps);
    EXPECT_EQ(tree.ranges()[0].upper, std::numbers::pi);
}

TEST(KinematicTree, ASingleLinkIsARobot) {
    const KinematicTree tree({"r", {{"only"}}});
    std::vector<RigidTransform<double>> poses(1, {.translation = {1, 1, 1}});
    tree.forward({}, poses);
    EXPECT_EQ(poses[0], RigidTransform<double>{});
}

std::string complaint(const RobotDescription& robot) {
    try {
        KinematicTree tree(robot);
        return "accepted";
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
}

TEST(KinematicTree, RefusesWhatIsNoTree) {
    using K = JointKind;
    const std::vector<LinkDescription> abc{{"a"}, {"b"}, {"c"}};
    EXPECT_THAT(complaint({"r"}), HasSubstr("no links"));
    EXPECT_THAT(complaint({"r", {{"a"}, {"a"}}}), HasSubstr("link 'a': there are two"));
    EXPECT_THAT(complaint({"r", {{""}}}), HasSubstr("no name"));
    EXPECT_THAT(complaint({"r", abc, {{"j", K::fixed, 0, 1}}}),
                AllOf(HasSubstr("two roots"), HasSubstr("'a'"), HasSubstr("'c'")));
    EXPECT_THAT(complaint({"r", abc, {{"j", K::fixed, 0, 1}, {"j", K::fixed, 1, 2}}}),
                HasSubstr("joint 'j': there are two"));
    EXPECT_THAT(complaint({"r", abc, {{"j", K::fixed, 0, 3}}}), HasSubstr("link number 3 of 3"));
    EXPECT_THAT(complaint({"r", abc, {{"j", K::fixed, 1, 1}}}), HasSubstr("to itself"));
    EXPECT_THAT(complaint({"r", abc, {{"j", K::fixed, 0, 2}, {"k", K::fixed, 1, 2}}}),
                AllOf(HasSubstr("link 'c' hangs on two joints"), HasSubstr("'k'")));
    EXPECT_THAT(complaint({"r", abc, {{"j", K::fixed, 2, 1}, {"k", K::fixed, 1, 2}}}),
                AllOf(HasSubstr("cycle"), HasSubstr("link")));
    EXPECT_THAT(
        complaint(
            {"r", abc, {{"j", K::fixed, 0, 1}, {"k", K::fixed, 1, 2}, {"l", K::fixed, 2, 0}}}),
        HasSubstr("cycle"));
}

TEST(KinematicTree, RefusesBadJoints) {
    const auto with = [](auto change) {
        RobotDescription robot{"r", {{"a"}, {"b"}}};
        robot.joints = {{"j", JointKind::revolute, 0, 1, {}, {0, 0, 1}, -1, 1}};
        change(robot.joints[0]);
        return complaint(robot);
    };
    const double nan = std::nan("");
    EXPECT_EQ(with([](JointDescription&) {}), "accepted");
    EXPECT_THAT(with([](auto& j) { j.axis = {}; }), HasSubstr("joint 'j': its axis is 0"));
    EXPECT_THAT(with([&](auto& j) { j.axis.y = nan; }), HasSubstr("axis"));
    EXPECT_EQ(with([](auto& j) { j.axis = {0, 1e-310, 1e-310}; }), "accepted");
    EXPECT_EQ(with([](auto& j) { j.axis = {1e308, 1e308, 1e308}; }), "accepted");
    EXPECT_THAT(with([](auto& j) { j.lower = 2; }), HasSubstr("lower limit"));
    EXPECT_THAT(with([&](auto& j) { j.upper = nan; }), HasSubstr("not finite"));
    EXPECT_THAT(with([](auto& j) { j.upper = INFINITY; }), HasSubstr("'continuous'"));
    EXPECT_THAT(with([&](auto& j) { j.origin.translation.x = nan; }), HasSubstr("not finite"));
    EXPECT_THAT(with([](auto& j) { j.origin.rotation[0] = {2, 0, 0}; }), HasSubstr("no rotation"));
    EXPECT_THAT(with([](auto& j) { j.origin.rotation[0] = {-1, 0, 0}; }), HasSubstr("no rotation"));
    EXPECT_THAT(with([](auto& j) { j.mimic = Mimic{0}; }), HasSubstr("mimics itself"));
    EXPECT_THAT(with([](auto& j) { j.mimic = Mimic{7}; }), HasSubstr("joint number 7"));
    EXPECT_EQ(with([](auto& j) { j.kind = JointKind::fixed, j.axis = {}, j.lower = 9; }),
              "accepted");
    EXPECT_THAT(with([](auto& j) { j.kind = JointKind::fixed, j.mimic = Mimic{0}; }),
                HasSubstr("is fixed and mimics"));

    RobotDescription robot = gripper();
    robot.joints[2].mimic = Mimic{0};
    EXPECT_THAT(complaint(robot), HasSubstr("mimics itself"));
    robot = gripper();
    robot.joints[1].mimic->multiplier = nan;
    EXPECT_THAT(complaint(robot), HasSubstr("mimic is not finite"));
    robot = gripper();
    robot.joints[2].kind = JointKind::fixed;
    EXPECT_THAT(complaint(robot), HasSubstr("which is fixed"));
}

TEST(KinematicTree, RefusesBadShapes) {
    const auto with = [](const LinkShape& shape) { return complaint({"r", {{"a", {{shape}}}}}); };
    EXPECT_EQ(with(LinkBox{{1, 0, 2}}), "accepted");
    EXPECT_EQ(with(LinkMesh{3, {-1, 1, 1}}), "accepted");
    EXPECT_THAT(with(LinkBox{{1, -1, 2}}), HasSubstr("link 'a': the side of a box is -1"));
    EXPECT_THAT(with(LinkSphere{-1}), HasSubstr("radius of a sphere"));
    EXPECT_THAT(with(LinkSphere{std::nan("")}), HasSubstr("radius of a sphere"));
    EXPECT_THAT(with(LinkCylinder{1, -2}), HasSubstr("length of a cylinder"));
    EXPECT_THAT(with(LinkCapsule{INFINITY, 2}), HasSubstr("radius of a capsule"));
    EXPECT_THAT(with(LinkMesh{0, {1, 0, 1}}), HasSubstr("scaled by 0"));
}

} // namespace
} // namespace boxwood
