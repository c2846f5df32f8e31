/// The narrow phase of robots' links against all their triangles.

#include "kernels/convex/signed_distance.h"
#include "kernels/triangle_distance/features.h"
#include "scenes/robots/random_values.h"
#include "scenes/robots/urdf.h"
#include "trees/world/bodies/robot_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

namespace boxwood {
namespace {

namespace fs = std::filesystem;

/// Pair by pair against all triangles, in states at random.
TEST(QueryRobotMeshes, AnswerForPandaAsAllItsTrianglesDo) {
    const fs::path panda = "../shared/data/robots/panda";
    if (!fs::is_directory(panda))
        GTEST_SKIP() << panda << " is not here: the sample robots are no part of the project";
    const UrdfRobot read = read_urdf(panda / "panda.urdf");
    const Robot robot(read.description);
    const RobotMeshes narrow(robot, read.meshes);
    std::vector<Pose> poses(robot.links().size());
    std::vector<double> values(robot.n_values());
    std::vector<std::vector<Triangle<double>>> placed(robot.links().size());
    std::size_t touching = 0, pairs = 0;
    for (std::uint64_t state = 0; state < 3; ++state) {
        random_values(robot.ranges(), 7, state, values);
        robot.poses(values, poses);
        for (std::size_t i = 0; i < placed.size(); ++i) {
            placed[i].clear();
            for (const LinkGeometry& geometry : robot.links()[i].geometries) {
                const TriangleMesh& mesh = read.meshes[std::get<LinkMesh>(geometry.shape).mesh];
                const Pose pose = compose(poses[i], geometry.origin);
                for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
                    const Triangle<float> t = mesh.triangle(k);
                    placed[i].push_back({pose(Vec3<double>(t.a)), pose(Vec3<double>(t.b)),
                                         pose(Vec3<double>(t.c))});
                }
            }
        }
        for (std::uint32_t a = 0; a < placed.size(); ++a)
            for (std::uint32_t b = a + 2; b < placed.size(); ++b) {
                if (placed[a].empty() || placed[b].empty())
                    continue;
                ++pairs;
                double least = std::numeric_limits<double>::infinity();
                for (const Triangle<double>& s : placed[a])
                    for (const Triangle<double>& t : placed[b])
                        least = std::min(least, FeaturesF64::distance(s, t).distance);
                const LinkDistance found =
                    narrow.distance(a, b, poses, std::numeric_limits<double>::infinity());
                EXPECT_NEAR(found.distance, least, 1e-12) << a << " " << b;
                EXPECT_EQ(narrow.collide(a, b, poses), least == 0);
                touching += least == 0;
            }
    }
    EXPECT_GT(pairs, 100u);
    EXPECT_LT(touching, pairs / 2);
}

/// Cylinders and meshes, part by part against all triangles.
TEST(QueryRobotMeshes, AnswerForZ1AsAllItsTrianglesDo) {
    const fs::path z1 = "../shared/data/robots/z1";
    if (!fs::is_directory(z1))
        GTEST_SKIP() << z1 << " is not here: the sample robots are no part of the project";
    const UrdfRobot read = read_urdf(z1 / "z1.urdf");
    const Robot robot(read.description);
    const RobotMeshes narrow(robot, read.meshes);
    constexpr double inf = std::numeric_limits<double>::infinity();
    struct Part {
        std::vector<Triangle<double>> triangles; ///< none: the cylinder
        convex::Cylinder cylinder;
        Pose pose;
    };
    // Roughly, and then those that may be the nearest.
    const auto least_of = [](const Part& a, const Part& b) {
        if (a.triangles.empty())
            return convex::signed_distance(a.cylinder, a.pose, b.cylinder, b.pose).distance;
        const auto measure = [&](const Triangle<double>& t, double relative) {
            return convex::signed_distance(t, Pose{}, b.cylinder, b.pose, {relative, 0});
        };
        std::vector<double> lower;
        double upper = inf, least = inf;
        for (const Triangle<double>& t : a.triangles) {
            const convex::SignedDistance rough = measure(t, 1e-3);
            lower.push_back(rough.lo);
            upper = std::min(upper, rough.hi);
        }
        for (std::size_t i = 0; i < lower.size(); ++i)
            if (lower[i] <= upper)
                least = std::min(least, measure(a.triangles[i], 0x1p-36).distance);
        return least;
    };
    std::vector<Pose> poses(robot.links().size());
    std::vector<double> values(robot.n_values());
    std::size_t touching = 0, with_meshes = 0, pairs = 0;
    // Two states, and the next one in which something may touch.
    const auto may_touch = [&] {
        for (std::uint32_t a = 0; a < poses.size(); ++a)
            for (std::uint32_t b = a + 2; b < poses.size(); ++b)
                if (narrow.collide(a, b, poses))
                    return true;
        return false;
    };
    for (std::uint64_t state = 0; state < 1000 && touching == 0; ++state) {
        random_values(robot.ranges(), 11, state, values);
        robot.poses(values, poses);
        if (state > 1 && !may_touch())
            continue;
        std::vector<std::vector<Part>> links(poses.size());
        for (std::size_t i = 0; i < links.size(); ++i)
            for (const LinkGeometry& geometry : robot.links()[i].geometries) {
                Part part;
                part.pose = compose(poses[i], geometry.origin);
                if (const auto* mesh = std::get_if<LinkMesh>(&geometry.shape))
                    for (std::size_t k = 0; k < read.meshes[mesh->mesh].triangles.size(); ++k) {
                        const Triangle<float> t = read.meshes[mesh->mesh].triangle(k);
                        part.triangles.push_back({part.pose(Vec3<double>(t.a)),
                                                  part.pose(Vec3<double>(t.b)),
                                                  part.pose(Vec3<double>(t.c))});
                    }
                else if (const auto* c = std::get_if<LinkCylinder>(&geometry.shape))
                    part.cylinder = {c->radius, c->length / 2};
                links[i].push_back(std::move(part));
            }
        for (std::uint32_t a = 0; a < links.size(); ++a)
            for (std::uint32_t b = a + 2; b < links.size(); ++b) {
                if (links[a].empty() || links[b].empty())
                    continue;
                double least = inf;
                for (const Part& of_a : links[a])
                    for (const Part& of_b : links[b]) {
                        ASSERT_TRUE(of_a.triangles.empty() || of_b.triangles.empty());
                        least = std::min(least, of_b.triangles.empty() ? least_of(of_a, of_b)
                                                                       : least_of(of_b, of_a));
                        with_meshes += !of_b.triangles.empty() || !of_a.triangles.empty();
                    }
                const LinkDistance found = narrow.distance(a, b, poses, inf);
                EXPECT_NEAR(found.distance, std::max(0.0, least), 1e-11) << a << " " << b;
                EXPECT_EQ(narrow.collide(a, b, poses), least <= 0) << a << " " << b;
                touching += least <= 0;
                ++pairs;
            }
    }
    EXPECT_GT(pairs, 30u);
    EXPECT_GT(with_meshes, 10u);
    EXPECT_GT(touching, 0u);
    EXPECT_LT(touching, pairs / 2);
}

} // namespace
} // namespace boxwood
