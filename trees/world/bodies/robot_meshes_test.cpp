#include "trees/world/bodies/robot_meshes.h"

#include "kernels/convex/signed_distance.h"
#include "kernels/triangle_distance/certified.h"
#include "trees/testing/test_meshes.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>
#include <variant>

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

/// A mesh as its triangles, or a solid, where it is put.
struct PlacedPart {
    std::vector<Triangle<double>> triangles;
    convex::Shape solid;
    Pose pose;
};

/// All triangles of two parts against each other, and against solids by the kernels of pairs.
convex::SignedDistance distance_by_force(const PlacedPart& a, const PlacedPart& b) {
    if (a.triangles.empty() && !b.triangles.empty())
        return distance_by_force(b, a);
    constexpr double inf = std::numeric_limits<double>::infinity();
    convex::SignedDistance least{inf, inf, inf};
    const auto take = [&](double lo, double hi) {
        least.lo = std::min(least.lo, lo);
        least.hi = std::min(least.hi, hi);
    };
    if (a.triangles.empty())
        return convex::signed_distance(a.solid, a.pose, b.solid, b.pose);
    for (const Triangle<double>& s : a.triangles) {
        if (b.triangles.empty()) {
            const convex::SignedDistance d = convex::signed_distance(s, Pose{}, b.solid, b.pose);
            take(d.lo, d.hi);
        }
        for (const Triangle<double>& t : b.triangles) {
            const Distance d = CertifiedDistance::distance(s, t);
            take(d.lo, d.hi);
        }
    }
    return least;
}

TEST(RobotMeshes, AreTestedPartByPart) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(-1.6, 1.6);
    const std::vector<TriangleMesh> meshes{noisy_sphere(5, 6, .2, 1)};
    const Pose aside = random_pose(random, {1, .5, 0});
    const Pose above = random_pose(random, {0, 0, .8});
    const std::vector<std::vector<LinkGeometry>> links{
        {{LinkMesh{0}, {}}, {LinkBox{{.5, 1, 2}}, aside}, {LinkCylinder{.2, 1}, above}},
        {{LinkMesh{0, {.5, .5, .5}}, aside}, {LinkMesh{0}, {}}, {LinkSphere{.3}, above}},
        {{LinkCapsule{.3, .7}, aside}, {LinkCylinder{.4, .6}, {}}}};
    auto with_empty = links;
    with_empty.push_back({});
    const Robot robot(loose_links(std::move(with_empty)));
    const RobotMeshes narrow(robot, meshes);
    const auto part_of = [&](const LinkGeometry& geometry, const Pose& link) {
        PlacedPart part;
        part.pose = compose(link, geometry.origin);
        if (const auto* mesh = std::get_if<LinkMesh>(&geometry.shape))
            part.triangles = placed(scaled(meshes[0], mesh->scale), part.pose);
        else if (const auto* box = std::get_if<LinkBox>(&geometry.shape))
            part.solid = convex::Box{0.5 * box->sides};
        else if (const auto* sphere = std::get_if<LinkSphere>(&geometry.shape))
            part.solid = convex::Sphere{sphere->radius};
        else if (const auto* cylinder = std::get_if<LinkCylinder>(&geometry.shape))
            part.solid = convex::Cylinder{cylinder->radius, .5 * cylinder->length};
        else if (const auto* capsule = std::get_if<LinkCapsule>(&geometry.shape))
            part.solid = convex::Capsule{capsule->radius, .5 * capsule->length};
        return part;
    };
    constexpr double inf = std::numeric_limits<double>::infinity();
    std::size_t touching = 0, apart = 0;
    for (int k = 0; k < 40; ++k) {
        std::vector<Pose> poses;
        for (int link = 0; link < 4; ++link)
            poses.push_back(random_pose(random, {2 * place(random), place(random), place(random)}));
        for (const auto& [a, b] : {Pair{0, 1}, {0, 2}, {1, 2}}) {
            double lo = inf, hi = inf;
            for (const LinkGeometry& of_a : links[a])
                for (const LinkGeometry& of_b : links[b]) {
                    const convex::SignedDistance d =
                        distance_by_force(part_of(of_a, poses[a]), part_of(of_b, poses[b]));
                    lo = std::min(lo, std::max(0.0, d.lo));
                    hi = std::min(hi, std::max(0.0, d.hi));
                }
            // Both sides are moved here, and one alone there: other roundings.
            const LinkDistance found = narrow.distance(a, b, poses, inf);
            EXPECT_LE(found.lo, hi + 1e-14);
            EXPECT_GE(found.hi, lo - 1e-14);
            EXPECT_LE(found.lo, found.distance);
            EXPECT_LE(found.distance, found.hi);
            EXPECT_EQ(narrow.collide(a, b, poses), hi == 0);
            EXPECT_EQ(narrow.collide(b, a, poses), hi == 0);
            EXPECT_EQ(narrow.distance(b, a, poses, inf).hi == 0, hi == 0);
            touching += hi == 0;
            apart += lo > 0;
            if (hi > 0) {
                EXPECT_LT(narrow.distance(a, b, poses, hi * 1.01).hi, hi * 1.01);
                const LinkDistance beyond = narrow.distance(a, b, poses, lo * .99);
                EXPECT_EQ(beyond.hi, inf);
                EXPECT_EQ(beyond.lo, lo * .99);
            }
        }
        EXPECT_FALSE(narrow.collide(0, 3, poses));
        EXPECT_EQ(narrow.distance(3, 1, poses, 5).lo, inf);
    }
    EXPECT_GT(touching, 10u);
    EXPECT_GT(apart, 20u);
}

TEST(RobotMeshes, HoldWhatIsInSolids) {
    const std::vector<TriangleMesh> meshes{noisy_sphere(5, 6, .2, 1, .1)};
    const Robot robot(loose_links({{{LinkMesh{0}, {}}},
                                   {{LinkBox{{1, 1, 1}}, {}}},
                                   {{LinkSphere{.2}, {}}},
                                   {{LinkMesh{0, {9, 9, 9}}, {}}}}));
    const RobotMeshes narrow(robot, meshes);
    const std::vector<Pose> poses(4);
    EXPECT_TRUE(narrow.collide(0, 1, poses));
    EXPECT_TRUE(narrow.collide(2, 1, poses));
    EXPECT_FALSE(narrow.collide(2, 3, poses)); // within a mesh, which is its surface
    EXPECT_GT(narrow.distance(3, 2, poses, 9).lo, .2);
}

TEST(RobotMeshes, SayWhichLinkTheyCannotTest) {
    try {
        const Robot robot(loose_links({{{LinkMesh{3}, {}}}}));
        RobotMeshes(robot, {});
        ADD_FAILURE() << "there is no such mesh";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "link link0 names mesh 3, and there are 0");
    }
}

/// A closed cube of half side 1 (mesh 0), an open one (mesh 1), and small things inside it.
TEST(RobotMeshes, LinksAreSolidOnRequest) {
    TriangleMesh open = cube_mesh(1);
    open.triangles.pop_back();
    const std::vector<TriangleMesh> meshes{cube_mesh(1), open};
    const Vec3<double> tenth{.1, .1, .1};
    const Robot robot(loose_links({{{LinkMesh{0}, {}}},
                                   {{LinkMesh{1}, {}}},
                                   {{LinkSphere{.1}, {}}},
                                   {{LinkMesh{0, tenth}, {}}}}));
    std::vector<Pose> poses(4);
    const RobotMeshes surfaces(robot, meshes), solids(robot, meshes, {.are_solid = true});
    constexpr double inf = std::numeric_limits<double>::infinity();
    constexpr double gap = .9;
    for (const std::uint32_t inner : {2u, 3u}) {
        EXPECT_FALSE(surfaces.collide(0, inner, poses));
        EXPECT_NEAR(surfaces.distance(0, inner, poses, inf).distance, gap, 1e-6);
        EXPECT_TRUE(solids.collide(0, inner, poses));
        EXPECT_TRUE(solids.collide(inner, 0, poses));
        EXPECT_EQ(solids.distance(0, inner, poses, inf).hi, 0);
        EXPECT_EQ(solids.distance(0, inner, poses, .5).hi, 0);
        EXPECT_FALSE(solids.collide(1, inner, poses)) << "an open mesh is no solid";
        EXPECT_NEAR(solids.distance(1, inner, poses, inf).distance, gap, 1e-6);
        EXPECT_EQ(solids.distance(1, inner, poses, gap / 2).lo, gap / 2);
        poses[inner].translation.x = 2; // outside
        EXPECT_FALSE(solids.collide(0, inner, poses));
        EXPECT_NEAR(solids.distance(inner, 0, poses, inf).distance, gap, 1e-6);
    }
}

} // namespace
} // namespace boxwood
