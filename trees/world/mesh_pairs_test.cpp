#include "trees/world/mesh_pairs.h"

#include "kernels/oracle/oracle.h"
#include "kernels/primitives/rotation.h"
#include "kernels/triangle_distance/certified.h"
#include "trees/builders/lbvh.h"
#include "trees/testing/all_pairs.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/test_meshes.h"
#include "trees/testing/triangle_soup.h"
#include "trees/world/box_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace boxwood {
namespace {

const Pose no_pose;

std::vector<Pair> touching_by_rationals(const TriangleMesh& a, const TriangleMesh& b,
                                        const Pose& pose) {
    std::vector<Pair> pairs;
    for (std::uint32_t i = 0; i < a.triangles.size(); ++i)
        for (std::uint32_t j = 0; j < b.triangles.size(); ++j) {
            const Triangle<double> s = triangle_at(a, i), t = triangle_at(b, j, pose);
            if (overlaps(s.bounds(), t.bounds()) && oracle::intersect(s, t))
                pairs.push_back({i, j});
        }
    return pairs;
}

/// How far a point is from a triangle, as one of three equal corners.
double distance_to(const Vec3<double>& p, const Triangle<double>& t) {
    return CertifiedDistance::distance({p, p, p}, t).hi;
}

class RandomPoses : public testing::TestWithParam<MeshVolume> {};
INSTANTIATE_TEST_SUITE_P(MeshPairs, RandomPoses, testing::Values(MeshVolume::obb, MeshVolume::aabb),
                         [](const auto& param) {
                             return param.param == MeshVolume::obb ? "obb" : "aabb";
                         });

TEST_P(RandomPoses, TouchAsRationalsSay) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1.6, 1.6);
    std::size_t hits = 0;
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        const TriangleMesh a = noisy_sphere(6, 7 + seed, .3, seed);
        const TriangleMesh b =
            seed % 2 == 0 ? noisy_sphere(9, 5, .2, seed) : triangle_soup(90, seed);
        const MeshTree tree_a(a, {.volume = GetParam()}), tree_b(b, {.builder = LbvhBuilder{}});
        for (int k = 0; k < 6; ++k) {
            const Pose pose = random_pose(random, {place(random), place(random), place(random)});
            const std::vector<Pair> expected = touching_by_rationals(a, b, pose);
            std::vector<Pair> got = touching_triangles(tree_a, tree_b, pose);
            std::ranges::sort(got);
            EXPECT_EQ(got, expected);
            EXPECT_EQ(collide(tree_a, tree_b, pose), !expected.empty());
            EXPECT_EQ(touching_triangles(tree_a, tree_b, pose, 3).size(),
                      std::min<std::size_t>(3, expected.size()));
            hits += expected.size();
        }
    }
    EXPECT_GT(hits, 500u);
}

/// A point within the edge along an axis that reaches farthest in a direction.
Vec3<double> on_farthest_edge(const TriangleMesh& box, int axis, Vec3<double> direction,
                              std::mt19937& random) {
    Vec3<double> point(box.vertices[7]);
    for (int i = 0; i < 3; ++i)
        point[i] = std::copysign(point[i], direction[i]);
    point[axis] *= std::uniform_real_distribution<double>(-.9, .9)(random);
    return point;
}

TEST(MeshPairs, OfBoxesWhoseEdgesMeetTouchAsRationalsSay) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> side(.2, 3), exponent(-52, -3);
    std::size_t touch = 0, parted_at_once = 0, apart = 0;
    for (int k = 0; k < 600; ++k) {
        const TriangleMesh a = box_mesh({side(random), side(random), side(random)});
        const TriangleMesh b = box_mesh({side(random), side(random), side(random)});
        const int axis_a = static_cast<int>(random() % 3), axis_b = static_cast<int>(random() % 3);
        Vec3<double> along_a, along_b;
        along_a[axis_a] = along_b[axis_b] = 1;
        Pose pose = random_pose(random, {});
        Vec3<double> out = cross(along_a, pose.rotated(along_b));
        out = 1 / length(out) * out;
        const Vec3<double> on_a = on_farthest_edge(a, axis_a, out, random);
        const Vec3<double> on_b =
            on_farthest_edge(b, axis_b, transposed_times(pose.rotation, -out), random);
        const double gap = k % 5 == 0 ? 0 : std::copysign(std::exp2(exponent(random)), k % 2 - .5);
        pose.translation = on_a - pose.rotated(on_b) + gap * out;
        const MeshTree tree_a(a), tree_b(b);
        Work work;
        const bool touching = !touching_by_rationals(a, b, pose).empty();
        ASSERT_EQ(collide(tree_a, tree_b, pose, &work), touching) << k;
        ASSERT_EQ(touching_triangles(tree_a, tree_b, pose).empty(), !touching) << k;
        touch += touching;
        apart += !touching && gap > 0x1p-12;
        parted_at_once += !touching && gap > 0x1p-12 && work.node_visits == 1;
    }
    EXPECT_GT(touch, 200u);
    EXPECT_GT(apart, 30u);
    EXPECT_EQ(parted_at_once, apart);
}

TEST(MeshPairs, BoxesSideBySideArePartedByOneTest) {
    std::mt19937 random(4);
    const MeshTree a(box_mesh({1, 2, 3})), b(box_mesh({2, 1, 1}));
    for (int axis = 0; axis < 3; ++axis)
        for (const bool of_b : {false, true}) { // along an axis of either
            Pose pose = random_pose(random, {});
            Vec3<double> way;
            way[axis] = 1;
            pose.translation = 2.8 * (of_b ? pose.rotated(way) : way);
            Work work;
            EXPECT_FALSE(collide(a, b, pose, &work));
            EXPECT_TRUE(touching_triangles(a, b, pose, 9, &work).empty());
            EXPECT_EQ(work.box_tests, 2u);
        }
}

TEST(MeshPairs, TouchTheSameForAnyNumberOfThreads) {
    const MeshTree a(noisy_sphere(40, 40, .1, 1)), b(noisy_sphere(35, 30, .1, 2));
    const MeshTree one(triangle_soup(1)), none;
    for (const double x : {0., .3, 1.2, 9.}) {
        Pose pose;
        pose.translation = {x, .1, -.2};
        for (const MeshTree* other : {&b, &one, &none}) {
            std::vector<Pair> expected = touching_triangles(a, *other, pose);
            std::ranges::sort(expected);
            const std::vector<Pair> serially = touching_triangles(a, *other, pose, serial());
            for (const auto& [name, executor] : every_executor())
                EXPECT_EQ(touching_triangles(a, *other, pose, *executor), serially) << name;
            std::vector<Pair> sorted = serially;
            std::ranges::sort(sorted);
            EXPECT_EQ(sorted, expected);
        }
    }
    EXPECT_GT(touching_triangles(a, b, Pose{}, serial()).size(), 100u);
}

TEST_P(RandomPoses, AreAsFarApartAsTheirTriangles) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-2.5, 2.5);
    std::size_t touching = 0;
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        const TriangleMesh a = noisy_sphere(5, 7 + seed, .3, seed);
        const TriangleMesh b =
            seed % 2 == 0 ? noisy_sphere(8, 5, .2, seed) : triangle_soup(70, seed);
        const MeshTree tree_a(a, {.volume = GetParam()}), tree_b(b);
        for (int k = 0; k < 5; ++k) {
            const Pose pose = random_pose(random, {place(random), place(random), place(random)});
            const Bounds truth = distance_of_all_pairs(a, b, pose);
            const MeshDistance got = distance(tree_a, tree_b, pose);
            expect_between(got, truth);
            touching += truth.hi == 0;
            if (truth.hi > 0) {
                EXPECT_LT(distance_to(got.point_a, triangle_at(a, got.triangles.a)), 1e-12);
                EXPECT_LT(distance_to(got.point_b, triangle_at(b, got.triangles.b, pose)), 1e-12);
                EXPECT_NEAR(length(got.point_b - got.point_a), got.distance, 1e-12);
            }
            DistanceOptions warm;
            warm.start = Pair{seed, static_cast<std::uint32_t>(k)};
            expect_between(distance(tree_a, tree_b, pose, warm), truth);
            for (const DistanceOptions& options : {DistanceOptions{}, warm}) {
                const MeshDistance plain = plain_distance(tree_a, tree_b, pose, options);
                ASSERT_TRUE(plain.found());
                EXPECT_NEAR(plain.distance, truth.hi, 1e-12);
                EXPECT_TRUE(plain.lo == plain.distance && plain.hi == plain.distance);
                EXPECT_NEAR(length(plain.point_b - plain.point_a), plain.distance, 1e-12);
            }
            EXPECT_EQ(plain_distance(tree_a, tree_b, pose, {.limit = truth.lo / 2}).found(), false);
            for (const double factor : {.5, 1 - 1e-6, 1 + 1e-6, 2.0}) {
                const MeshWithin near = within(tree_a, tree_b, pose, truth.hi * factor);
                EXPECT_EQ(near.within, truth.hi <= truth.hi * factor);
                EXPECT_LE(near.lo, truth.hi);
                EXPECT_GE(near.hi, truth.lo);
            }
        }
    }
    EXPECT_GT(touching, 5u);
    EXPECT_LT(touching, 35u);
}

TEST(MeshPairs, TolerancesSaveWorkAndKeepTheirBound) {
    const MeshTree a(noisy_sphere(40, 40, .05, 1)), b(noisy_sphere(40, 40, .05, 2));
    Pose pose;
    pose.translation = {1.9, 1.1, .7};
    const MeshDistance sure = distance(a, b, pose);
    std::uint64_t visits = std::numeric_limits<std::uint64_t>::max();
    for (const double relative : {0.0, .01, .1, .5, .9}) {
        DistanceOptions options;
        options.relative = relative;
        Work work;
        const MeshDistance got = distance(a, b, pose, options, &work);
        EXPECT_LE(got.lo, sure.hi);
        EXPECT_GE(got.hi, sure.lo);
        EXPECT_LE(got.hi * (1 - relative), got.lo * (1 + 1e-9));
        EXPECT_LE(work.node_visits, visits);
        visits = work.node_visits;
    }
    EXPECT_LT(visits, 200u);
    DistanceOptions options;
    options.absolute = .2;
    const MeshDistance got = distance(a, b, pose, options);
    EXPECT_LE(got.hi, got.lo + .2 + 1e-9);
    EXPECT_LE(got.lo, sure.hi);
    options = {};
    options.limit = sure.lo * (1 - 1e-9);
    const MeshDistance nothing = distance(a, b, pose, options);
    EXPECT_FALSE(nothing.found());
    EXPECT_EQ(nothing.lo, options.limit);
}

// Hard cases with known answers: ../shared/reference/hard-cases.md names them.

TEST(MeshPairs, TinyTrianglesHaveADistance) {
    for (const float s : {1.7e-4f, 1e-4f, 1e-5f, 1e-12f}) {
        const float h = s / 10, q = s / 4;
        const MeshTree a(one_triangle({0, 0, 0}, {s, 0, 0}, {0, s, 0}));
        const MeshTree b(one_triangle({q, q, h}, {5 * q, q, h + s}, {q, 5 * q, h + s}));
        const MeshDistance d = distance(a, b, no_pose);
        EXPECT_NEAR(d.distance, double{h}, 1e-6 * double{h});
        EXPECT_FALSE(collide(a, b, no_pose));
    }
}

TEST(MeshPairs, CoplanarTrianglesThatAreApartDoNotTouch) {
    const MeshTree a(one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    const MeshTree b(one_triangle({10, 10, 0}, {11, 10, 0}, {10, 11, 0}));
    EXPECT_FALSE(collide(a, b, no_pose));
    EXPECT_NEAR(distance(a, b, no_pose).distance, 13.435028842544403, 1e-12);
}

TEST(MeshPairs, WhatIsInsideIsApart) {
    const MeshTree outer(cube_mesh(1)), inner(cube_mesh(.1f, {.2f, .1f, 0}));
    EXPECT_FALSE(collide(outer, inner, no_pose));
    EXPECT_NEAR(distance(outer, inner, no_pose).distance, .7, 1e-6);
}

TEST(MeshPairs, CubesThatShareAFaceTouch) {
    const MeshTree cube(cube_mesh(1));
    Pose pose;
    for (const double x : {2.0, -2.0}) {
        pose.translation = {x, 0, 0};
        EXPECT_TRUE(collide(cube, cube, pose));
        EXPECT_EQ(distance(cube, cube, pose).hi, 0);
        pose.translation.x = std::nextafter(x, 3 * x);
        EXPECT_FALSE(collide(cube, cube, pose));
        const MeshDistance d = distance(cube, cube, pose);
        EXPECT_GT(d.lo, 0);
        EXPECT_NEAR(d.hi, 0x1p-51, 0x1p-80);
    }
}

TEST(MeshPairs, FlatParallelPlatesAreNoTrap) {
    // All pairs of triangles that face each other are at the same distance.
    const MeshTree below(plate(60, 0)), above(plate(60, .05f));
    Work work;
    const MeshDistance d = distance(below, above, no_pose, {}, &work);
    EXPECT_NEAR(d.distance, double{.05f}, 1e-15);
    EXPECT_LT(work.triangle_tests, 2000u);
    EXPECT_LT(work.node_visits, 500u);
}

TEST(MeshPairs, NearContactBoundsStayNarrow) {
    std::mt19937 random(5);
    const TriangleMesh a = noisy_sphere(6, 7, .2, 1), b = noisy_sphere(5, 8, .2, 2);
    const MeshTree tree_a(a), tree_b(b);
    for (const double gap : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11})
        for (int k = 0; k < 4; ++k) {
            Pose pose = random_pose(random, {});
            const Vec3<double> way{.48, .6, .64};
            pose.translation = 3.0 * way;
            for (int step = 0; step < 60; ++step) { // towards each other, to about the gap
                const double d = distance(tree_a, tree_b, pose).distance;
                pose.translation = pose.translation + (gap - d) * .9 * way;
            }
            const Bounds truth = distance_of_all_pairs(a, b, pose);
            ASSERT_GT(truth.hi, 0);
            expect_between(distance(tree_a, tree_b, pose), truth);
        }
}

TEST(MeshPairs, NestedSpheresOpenLeavesNotTriangles) {
    const MeshTree inner(noisy_sphere(60, 60, 0, 1)), outer(noisy_sphere(60, 60, 0, 1, 1.001));
    Work work;
    const MeshDistance d = distance(inner, outer, no_pose, {}, &work);
    EXPECT_GT(d.lo, 9.9e-4);
    EXPECT_LT(work.triangle_tests, 4 * inner.size());
}

// Metamorphic.

TEST(MeshPairs, SwappedSidesAgree) {
    std::mt19937 random(3);
    const MeshTree a(noisy_sphere(10, 9, .2, 1)), b(noisy_sphere(8, 11, .3, 2));
    std::uniform_real_distribution<double> place(-2, 2);
    for (int k = 0; k < 200; ++k) {
        const Pose there = random_pose(random, {place(random), place(random), place(random)});
        const Pose back = relative_pose(there, no_pose);
        const MeshDistance d = distance(a, b, there), e = distance(b, a, back);
        EXPECT_NEAR(d.distance, e.distance, 1e-14);
        if (d.distance == 0 || d.distance > 1e-12) { // corners are rounded on one side
            EXPECT_EQ(collide(a, b, there), collide(b, a, back));
            EXPECT_EQ(within(a, b, there, .3).within, within(b, a, back, .3).within);
        }
    }
}

TEST(MeshPairs, ARigidMotionOfBothChangesLittle) {
    std::mt19937 random(4);
    const MeshTree a(noisy_sphere(10, 9, .2, 1)), b(noisy_sphere(8, 11, .3, 2));
    std::uniform_real_distribution<double> place(-2, 2);
    std::size_t touching = 0;
    for (int k = 0; k < 40; ++k) {
        const Pose at_a = random_pose(random, {}), moved = random_pose(random, {30, -20, 10});
        const Pose at_b = random_pose(random, {place(random), place(random), 0});
        const Pose after = relative_pose(compose(moved, at_a), compose(moved, at_b));
        const MeshDistance d = distance(a, b, relative_pose(at_a, at_b)), e = distance(a, b, after);
        EXPECT_NEAR(d.distance, e.distance, 1e-12);
        expect_between(e, distance_of_all_pairs(a.mesh(), b.mesh(), after));
        touching += d.hi == 0;
    }
    EXPECT_GT(touching, 10u);
    EXPECT_LT(touching, 35u);
}

TEST(MeshPairs, PowersOfTwoChangeNothing) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(-2, 2);
    const TriangleMesh a = noisy_sphere(10, 9, .2, 1), b = noisy_sphere(8, 11, .3, 2);
    const MeshTree tree_a(a), tree_b(b);
    std::vector<Pose> poses{random_pose(random, {1.3, 1.2, 1.1})};
    for (int k = 0; k < 30; ++k)
        poses.push_back(random_pose(random, {place(random), place(random), place(random)}));
    const auto all_pairs = [](const MeshTree& s, const MeshTree& t, const Pose& pose) {
        std::vector<Pair> pairs = touching_triangles(s, t, pose);
        std::ranges::sort(pairs);
        return pairs;
    };
    std::size_t touching = 0;
    for (const int exponent : {-60, -20, 20, 56}) {
        const auto scaled = [&](TriangleMesh mesh) {
            for (Vec3<float>& v : mesh.vertices)
                v = std::ldexp(1.0f, exponent) * v;
            return MeshTree(std::move(mesh));
        };
        const MeshTree scaled_a = scaled(a), scaled_b = scaled(b);
        for (const Pose& pose : poses) {
            Pose there = pose;
            there.translation = std::ldexp(1.0, exponent) * pose.translation;
            const MeshDistance d = distance(tree_a, tree_b, pose),
                               e = distance(scaled_a, scaled_b, there);
            EXPECT_NEAR(std::ldexp(e.distance, -exponent), d.distance, 1e-12);
            const std::vector<Pair> pairs = all_pairs(tree_a, tree_b, pose);
            EXPECT_EQ(all_pairs(scaled_a, scaled_b, there), pairs);
            EXPECT_EQ(collide(scaled_a, scaled_b, there), !pairs.empty());
            touching += !pairs.empty();
        }
    }
    EXPECT_GT(touching, 4u * 5);
    EXPECT_LT(touching, 4u * 28);
}

TEST(MeshPairs, WindingChangesNothing) {
    TriangleMesh a = noisy_sphere(10, 9, .2, 1);
    const MeshTree before(a), b(noisy_sphere(8, 11, .3, 2));
    for (std::size_t i = 0; i < a.triangles.size(); i += 2)
        std::swap(a.triangles[i][0], a.triangles[i][1]);
    const MeshTree after(a);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-2, 2);
    std::size_t touching = 0;
    for (int k = 0; k < 40; ++k) {
        const Pose pose = random_pose(random, {place(random), place(random), place(random)});
        std::vector<Pair> x = touching_triangles(before, b, pose),
                          y = touching_triangles(after, b, pose);
        std::ranges::sort(x);
        std::ranges::sort(y);
        EXPECT_EQ(x, y);
        EXPECT_EQ(collide(after, b, pose), !x.empty());
        EXPECT_NEAR(distance(after, b, pose).distance, distance(before, b, pose).distance, 1e-13);
        touching += !x.empty();
    }
    EXPECT_GT(touching, 5u);
    EXPECT_LT(touching, 35u);
}

// What they are given.

TEST(MeshPairs, EmptyAndSingleTriangles) {
    const MeshTree nothing, one(one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    EXPECT_FALSE(collide(nothing, one, no_pose));
    EXPECT_FALSE(collide(one, nothing, no_pose));
    EXPECT_TRUE(touching_triangles(nothing, nothing, no_pose).empty());
    const MeshDistance d = distance(nothing, one, no_pose);
    EXPECT_FALSE(d.found());
    EXPECT_EQ(d.distance, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(collide(one, one, no_pose));
    EXPECT_EQ(distance(one, one, no_pose).hi, 0);
}

TEST(MeshPairs, DegenerateTrianglesArePointsAndSegments) {
    const TriangleMesh points{{{0, 0, 0}, {3, 0, 0}}, {{0, 0, 0}, {0, 1, 1}, {0, 0, 1}}};
    const TriangleMesh other = one_triangle({1, -1, 2}, {1, 1, 2}, {1, 0, 3});
    const MeshDistance d = distance(MeshTree(points), MeshTree(other), no_pose);
    EXPECT_DOUBLE_EQ(d.distance, 2);
    Pose pose;
    pose.translation = {0, 0, -2.5};
    EXPECT_TRUE(collide(MeshTree(points), MeshTree(other), pose));
}

TEST(MeshPairs, BadInputIsRefused) {
    TriangleMesh mesh = one_triangle({0, 0, 0}, {1, 0, 0}, {0, std::nanf(""), 0});
    EXPECT_THROW(MeshTree{mesh}, InvalidBox);
    mesh.vertices[2].y = 0x1p60f;
    EXPECT_THROW(MeshTree{mesh}, InvalidBox);
    mesh.vertices.resize(2);
    EXPECT_THROW(MeshTree{mesh}, std::invalid_argument);
    const MeshTree cube(cube_mesh(1));
    EXPECT_THROW(distance(cube, cube, no_pose, {.relative = 1}), std::invalid_argument);
    EXPECT_THROW(distance(cube, cube, no_pose, {.absolute = -1}), std::invalid_argument);
    EXPECT_THROW(distance(cube, cube, no_pose, {.start = Pair{12, 0}}), std::invalid_argument);
    EXPECT_THROW(within(cube, cube, no_pose, std::nan("")), std::invalid_argument);
    Pose pose;
    for (const double bad : {std::nan(""), 0x1p63}) {
        pose.translation.y = bad;
        EXPECT_THROW(collide(cube, cube, pose), std::invalid_argument);
        EXPECT_THROW(distance(cube, cube, pose), std::invalid_argument);
    }
}

} // namespace
} // namespace boxwood
