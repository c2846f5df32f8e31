#include "trees/world/robot_meshes.h"

#include "kernels/triangle_distance/certified.h"
#include "trees/testing/test_meshes.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace boxwood {
namespace {

/// Links that hang nowhere in particular: a test puts them where it wants them.
RobotDescription loose_links(std::vector<std::vector<LinkGeometry>> geometries) {
    RobotDescription robot{"loose"};
    for (std::uint32_t i = 0; i < geometries.size(); ++i) {
        robot.links.push_back({"link" + std::to_string(i), std::move(geometries[i])});
        if (i > 0)
            robot.joints.push_back({"joint" + std::to_string(i), JointKind::fixed, i - 1, i});
    }
    return robot;
}

std::vector<Triangle<double>> placed(const TriangleMesh& mesh, const Pose& pose) {
    std::vector<Triangle<double>> all;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        all.push_back(triangle_at(mesh, i, pose));
    return all;
}

TEST(RobotMeshes, AreTestedPartByPart) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(-1.6, 1.6);
    const std::vector<TriangleMesh> meshes{noisy_sphere(5, 6, .2, 1)};
    const Pose aside = random_pose(random, {1, .5, 0});
    const Robot robot(loose_links({{{LinkMesh{0}, {}}, {LinkBox{{.5, 1, 2}}, aside}},
                                   {{LinkMesh{0, {.5, .5, .5}}, aside}, {LinkMesh{0}, {}}},
                                   {}}));
    const RobotMeshes narrow(robot, meshes);
    std::size_t touching = 0;
    for (int k = 0; k < 40; ++k) {
        std::vector<Pose> poses;
        for (int link = 0; link < 3; ++link)
            poses.push_back(random_pose(random, {2 * place(random), place(random), place(random)}));
        double lo = std::numeric_limits<double>::infinity(), hi = lo;
        const std::vector<std::vector<Triangle<double>>> of_a{
            placed(meshes[0], poses[0]), placed(box_mesh({.5, 1, 2}), compose(poses[0], aside))};
        const std::vector<std::vector<Triangle<double>>> of_b{
            placed(scaled(meshes[0], {.5, .5, .5}), compose(poses[1], aside)),
            placed(meshes[0], poses[1])};
        for (const auto& part_a : of_a)
            for (const auto& part_b : of_b)
                for (const auto& s : part_a)
                    for (const auto& t : part_b) {
                        const Distance d = CertifiedDistance::distance(s, t);
                        lo = std::min(lo, d.lo);
                        hi = std::min(hi, d.hi);
                    }
        // Both sides are moved here, and one alone there: other roundings.
        const LinkDistance found =
            narrow.distance(0, 1, poses, std::numeric_limits<double>::infinity());
        EXPECT_LE(found.lo, hi + 1e-14);
        EXPECT_GE(found.hi, lo - 1e-14);
        EXPECT_EQ(narrow.collide(0, 1, poses), hi == 0);
        EXPECT_EQ(narrow.collide(1, 0, poses), hi == 0);
        touching += hi == 0;
        if (hi > 0) {
            EXPECT_LT(narrow.distance(0, 1, poses, hi * 1.01).hi, hi * 1.01);
            EXPECT_EQ(narrow.distance(0, 1, poses, lo * .99).hi,
                      std::numeric_limits<double>::infinity());
        }
        EXPECT_FALSE(narrow.collide(0, 2, poses));
        EXPECT_EQ(narrow.distance(2, 1, poses, 5).lo, std::numeric_limits<double>::infinity());
    }
    EXPECT_GT(touching, 3u);
    EXPECT_LT(touching, 37u);
}

TEST(RobotMeshes, SayWhichLinkTheyCannotTest) {
    const auto complaint = [](LinkShape shape) -> std::string {
        try {
            const Robot robot(loose_links({{{shape, {}}}}));
            RobotMeshes(robot, {});
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(complaint(LinkCylinder{1, 2}),
              "link link0 has a cylinder, and only meshes and boxes are tested so far");
    EXPECT_NE(complaint(LinkSphere{1}).find("sphere"), std::string::npos);
    EXPECT_NE(complaint(LinkMesh{3}).find("link0 names mesh 3"), std::string::npos);
}

} // namespace
} // namespace boxwood
