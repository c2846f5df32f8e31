#include "trees/world/robot.h"

#include "kernels/primitives/rotation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

namespace boxwood {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using std::numbers::pi;

/// base - turntable (continuous) - arm (revolute, 1 .. 2) - finger (prismatic) and its twin.
RobotDescription small_robot() {
    RobotDescription robot{"small", {{"base"}, {"table"}, {"arm"}, {"finger"}, {"twin"}}};
    robot.joints = {{"turn", JointKind::continuous, 0, 1, {.translation = {0, 0, 1}}, {0, 0, 1}},
                    {"swing", JointKind::revolute, 1, 2, {}, {0, 1, 0}, 1, 2},
                    {"copy", JointKind::prismatic, 2, 4, {}, {0, -1, 0}, 0, 1, Mimic{3}},
                    {"close", JointKind::prismatic, 2, 3, {}, {0, 1, 0}, -3, -1}};
    return robot;
}

TEST(Robot, ValuesAreThoseOfJointsThatMoveByThemselves) {
    const Robot robot(small_robot());
    EXPECT_EQ(robot.n_values(), 3u);
    EXPECT_EQ(robot.value_name(2), "close");
    EXPECT_EQ(robot.value("close"), 2u);
    EXPECT_EQ(robot.link("twin"), 4u);
    EXPECT_THAT(robot.rest(), ElementsAre(0, 1, -1));
    using E = std::invalid_argument;
    EXPECT_THAT([&] { robot.link("tabel"); }, ThrowsMessage<E>(HasSubstr("did you mean 'table'")));
    EXPECT_THAT([&] { robot.value("swin"); }, ThrowsMessage<E>(HasSubstr("did you mean 'swing'")));
    EXPECT_THAT([&] { robot.value("copy"); }, ThrowsMessage<E>(HasSubstr("mimics joint 'close'")));
}

TEST(Robot, PosesRefuseWrongSizesAndValues) {
    const Robot robot(small_robot());
    std::vector<RigidTransform<double>> poses(5);
    robot.poses(robot.rest(), poses);
    EXPECT_EQ(poses[1].translation, (Vec3<double>{0, 0, 1}));
    using E = std::invalid_argument;
    EXPECT_THAT(
        [&] {
            robot.poses(std::vector{1., 2.}, poses);
        },
        ThrowsMessage<E>(HasSubstr("2 joint values are given; the robot has 3")));
    EXPECT_THAT(
        [&] {
            robot.poses(std::vector{0., std::nan(""), 0.}, poses);
        },
        ThrowsMessage<E>(HasSubstr("joint 'swing' is nan")));
    EXPECT_THAT(
        [&] {
            robot.poses(std::vector{0., 1., -0x1p61}, poses);
        },
        ThrowsMessage<E>(HasSubstr("link 'finger' lies beyond 2^60")));
    RobotDescription mad = small_robot();
    mad.joints[2] = {"copy", JointKind::continuous, 2, 4, {}, {0, 1, 0}, 0, 0, Mimic{0, 1e300}};
    EXPECT_THAT(
        [&] {
            Robot(mad).poses(std::vector{1e300, 1., -1.}, poses);
        },
        ThrowsMessage<E>(HasSubstr("link 'twin' is turned by an angle that is not finite")));
    poses.pop_back();
    EXPECT_THROW(robot.poses(robot.rest(), poses), E);
}

TEST(Robot, InterpolatesInProportionAndTheShorterWayRound) {
    const Robot robot(small_robot());
    std::vector<double> out(3);
    const std::vector<double> from{3, 1, -1}, to{-3, 2, -3};
    robot.interpolate(from, to, .25, out);
    EXPECT_NEAR(out[0], 3 + (2 * pi - 6) / 4, 1e-15); // through pi
    EXPECT_EQ(out[1], 1.25);
    EXPECT_EQ(out[2], -1.5);
    robot.interpolate(from, to, 0, out);
    EXPECT_EQ(out, from);
    robot.interpolate(from, to, 1, out);
    EXPECT_NEAR(out[0], -3 + 2 * pi, 1e-15);
    EXPECT_EQ(out[2], -3);
    std::vector<double> in_place = from;
    robot.interpolate(in_place, to, .25, in_place);
    EXPECT_EQ(in_place[1], 1.25);
    EXPECT_THROW(robot.interpolate(from, std::vector{1.}, .5, out), std::invalid_argument);
}

TEST(JointPath, PassesThroughItsStates) {
    const Robot robot(small_robot());
    const JointPath path(robot, {{0, 1, -1}, {1, 2, -2}, {2, 1, -3}});
    std::vector<double> out(3);
    const auto at = [&](double s) {
        path.at(s, out);
        return out;
    };
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_THAT(at(static_cast<double>(i)), ::testing::ElementsAreArray(path.state(i)));
    EXPECT_THAT(at(.5), ElementsAre(.5, 1.5, -1.5));
    EXPECT_THAT(at(1.25), ElementsAre(1.25, 1.75, -2.25));
    EXPECT_THAT(at(-1), ElementsAre(0, 1, -1));
    EXPECT_THAT(at(99), ElementsAre(2, 1, -3));
    EXPECT_THAT(at(std::nan("")), ElementsAre(0, 1, -1));
    EXPECT_THROW(JointPath(robot, {}), std::invalid_argument);
    EXPECT_THROW(JointPath(robot, {{0, 1}}), std::invalid_argument);
    EXPECT_THROW(JointPath(robot, {{0, 1, INFINITY}}), std::invalid_argument);
    const JointPath one(robot, {{0, 1, -1}});
    one.at(.5, out);
    EXPECT_THAT(out, ElementsAre(0, 1, -1));
}

/// Random points of a shape, in its own frame, that reach its ends.
class PointOf {
  public:
    PointOf(const Aabb<float>& mesh_box, std::mt19937_64& bits) : box_(mesh_box), bits_(bits) {}

    Vec3<double> operator()(const LinkMesh& m) {
        const Aabb<double> box(box_);
        const Vec3<double> p{end() < 0 ? box.min.x : box.max.x, end() < 0 ? box.min.y : box.max.y,
                             end() < 0 ? box.min.z : box.max.z};
        return {p.x * m.scale.x, p.y * m.scale.y, p.z * m.scale.z};
    }
    Vec3<double> operator()(const LinkBox& b) {
        return {end() * b.sides.x / 2, end() * b.sides.y / 2, end() * b.sides.z / 2};
    }
    Vec3<double> operator()(const LinkSphere& s) { return s.radius * direction(real(-1, 1)); }
    Vec3<double> operator()(const LinkCylinder& c) {
        return c.radius * direction(0) + Vec3<double>{0, 0, end() * c.length / 2};
    }
    Vec3<double> operator()(const LinkCapsule& c) {
        return c.radius * direction(real(-1, 1)) + Vec3<double>{0, 0, end() * c.length / 2};
    }

  private:
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(bits_);
    }
    double end() { return real(-1, 1) < 0 ? -1 : 1; }
    /// A little less than 1 long, for what cos and sin round.
    Vec3<double> direction(double z) {
        const double turn = real(0, 2 * pi), r = std::sqrt(1 - z * z);
        return .999999 * Vec3<double>{r * std::cos(turn), r * std::sin(turn), z};
    }
    const Aabb<float>& box_;
    std::mt19937_64& bits_;
};

TEST(LinkBoxes, HoldEveryPointOfTheGeometry) {
    std::mt19937_64 bits(11);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(bits);
    };
    const auto pose = [&] {
        const Vec3<double> axis{real(-1, 1), real(-1, 1), real(.1, 1)};
        return RigidTransform<double>{rotation_about(axis * (1 / length(axis)), real(-4, 4)),
                                      {real(-1, 1), real(-1, 1), real(-1, 1)}};
    };
    RobotDescription description = small_robot();
    auto& links = description.links;
    links[0].geometries = {{LinkMesh{1, {-2, .1, 3}}, pose()}};
    links[1].geometries = {{LinkBox{{1, 2, .3}}, pose()}, {LinkSphere{.1}, pose()}};
    links[2].geometries = {{LinkCylinder{.1, .7}, pose()}, {LinkCapsule{.2, .3}, pose()}};
    links[4].geometries = {{LinkSphere{1}, {}}};
    const std::vector<Aabb<float>> meshes{{}, {{-1, -2, 0.1f}, {0.3f, 2, 3}}};
    const Robot robot(description);
    const LinkBoxes boxes(robot, meshes);
    EXPECT_THAT(boxes.links(), ElementsAre(0, 1, 2, 4));
    std::vector<RigidTransform<double>> poses(5);
    std::vector<Aabb<double>> around(5);
    for (int state = 0; state < 200; ++state) {
        robot.poses(std::vector{real(-4, 4), real(1, 2), real(-3, -1)}, poses);
        boxes.boxes(poses, around);
        EXPECT_TRUE(around[3].is_empty());
        for (std::size_t i = 0; i < 5; ++i)
            for (const LinkGeometry& geometry : robot.links()[i].geometries)
                for (int k = 0; k < 20; ++k) {
                    const Vec3<double> p = std::visit(PointOf(meshes[1], bits), geometry.shape);
                    ASSERT_TRUE(around[i].contains(poses[i](geometry.origin(p)))) << "link " << i;
                }
    }
    // A sphere about the origin of its link has no larger box than it must.
    const Vec3<double> size = around[4].max - around[4].min;
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_LE(size[axis], 2 * std::numbers::sqrt3 + 1e-12);
}

TEST(LinkBoxes, HoldScaledMeshesToTheLastBit) {
    std::mt19937_64 bits(2);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(bits);
    };
    for (int round = 0; round < 200; ++round) {
        TriangleMesh mesh;
        Aabb<float> box;
        for (int i = 0; i < 3; ++i) {
            mesh.vertices.push_back(
                Vec3<float>(Vec3<double>{real(-1, 1), real(-1, 1), real(-1, 1)}));
            box.extend(mesh.vertices.back());
        }
        mesh.triangles = {{0, 1, 2}};
        const Vec3<double> scale{real(-2, 2), real(-.001, .001), real(-1e6, 1e6)};
        const Robot robot({"r", {{"a", {{LinkMesh{0, scale}, {}}}}}});
        std::vector<RigidTransform<double>> poses(1);
        std::vector<Aabb<double>> around(1);
        LinkBoxes(robot, std::vector{box}).boxes(poses, around);
        const TriangleMesh large = scaled(mesh, scale);
        for (const Vec3<float>& vertex : large.vertices)
            ASSERT_TRUE(around[0].contains(Vec3<double>(vertex)));
        // Outside stays outside: the normal of the scaled triangle is that of the first one over
        // the scale, up to its length.
        const auto normal = [](const TriangleMesh& m) {
            const Triangle<float> t = m.triangle(0);
            return cross(Vec3<double>(t.b) - Vec3<double>(t.a),
                         Vec3<double>(t.c) - Vec3<double>(t.a));
        };
        const Vec3<double> n = normal(mesh), m = normal(large);
        ASSERT_GT(n.x / scale.x * m.x + n.y / scale.y * m.y + n.z / scale.z * m.z, 0);
    }
    EXPECT_EQ(scaled({{{1, 2, 3}}, {}}, {1, 1, 1}).vertices[0], (Vec3<float>{1, 2, 3}));
}

TEST(LinkBoxes, RefusesMeshesThatAreNotThere) {
    RobotDescription description = small_robot();
    description.links[1].geometries = {{LinkMesh{1}, {}}};
    const Robot robot(description);
    const std::vector<Aabb<float>> one(1), empty(2);
    EXPECT_THAT([&] { LinkBoxes(robot, one); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("'table' has mesh number 1 of 1")));
    EXPECT_THAT([&] { LinkBoxes(robot, empty); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("is empty")));
}

} // namespace
} // namespace boxwood
