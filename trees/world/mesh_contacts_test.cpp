#include "trees/world/mesh_contacts.h"

#include "kernels/triangle_distance/certified.h"
#include "trees/testing/test_meshes.h"
#include "trees/world/mesh_shape.h"
#include "trees/world/solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

namespace boxwood {
namespace {

TEST(Contacts, WindingChangesNothing) {
    // Hard case 6: FCL says depth 1 along y for one of the two.
    const Triangle<double> b{{0, 0, -.001}, {10, 0, 10}, {-10, 0, 10}};
    for (const Triangle<double>& a : {Triangle<double>{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}},
                                      Triangle<double>{{1, -1, 0}, {-1, -1, 0}, {0, 1, 0}}}) {
        const Contact contact = contact_of(a, b);
        EXPECT_NEAR(contact.depth, .001, 1e-15);
        EXPECT_EQ(contact.normal, (Vec3<double>{0, 0, 1}));
        EXPECT_LT(length(contact.point), .002);
    }
}

TEST(Contacts, WindingOfAMeshChangesNothing) {
    std::mt19937 random(6);
    TriangleMesh a = noisy_sphere(10, 9, .2, 1);
    const MeshTree before(a), b(noisy_sphere(8, 11, .3, 2));
    for (std::size_t i = 0; i < a.triangles.size(); i += 2)
        std::swap(a.triangles[i][0], a.triangles[i][1]);
    const MeshTree after(a);
    for (int k = 0; k < 20; ++k) {
        const Pose pose = random_pose(random, {.05 * k, .3, .4});
        const std::vector<Contact> x = contacts(before, b, pose), y = contacts(after, b, pose);
        ASSERT_EQ(x.size(), y.size());
        EXPECT_FALSE(x.empty());
        for (std::size_t i = 0; i < x.size(); ++i) // the deepest first
            EXPECT_NEAR(x[i].depth, y[i].depth, 1e-12);
    }
}

/// Of near triangles, by all pairs: those that surely are, and those that may be within rounding.
TEST(Contacts, AMarginMakesNearTrianglesMeet) {
    std::mt19937 random(9);
    const TriangleMesh a = noisy_sphere(10, 11, .2, 1), b = noisy_sphere(9, 10, .2, 2);
    const MeshTree tree_a(a), tree_b(b);
    std::size_t near = 0, touching = 0;
    for (const double reach : {0.0, .01, .2, 1.0})
        for (int k = 0; k < 6; ++k) {
            const Pose pose = random_pose(random, {1.3 + .3 * k, .4, .2});
            std::vector<Pair> found = near_triangles(tree_a, tree_b, pose, reach);
            const std::vector<Pair> first = near_triangles(tree_a, tree_b, pose, reach, 3);
            EXPECT_TRUE(std::ranges::equal(first, std::span(found).first(first.size())));
            std::ranges::sort(found);
            const std::vector<Contact> all = contacts(tree_a, tree_b, pose, {.margin = reach});
            EXPECT_TRUE(std::ranges::is_sorted(all, {}, [](const Contact& c) { return -c.depth; }));
            std::size_t expected = 0;
            for (std::uint32_t i = 0; i < tree_a.size(); ++i)
                for (std::uint32_t j = 0; j < tree_b.size(); ++j) {
                    const Distance d = CertifiedDistance::distance(tree_a.triangle(i, Pose{}),
                                                                   tree_b.triangle(j, pose));
                    ASSERT_EQ(std::ranges::binary_search(found, Pair{i, j}), d.lo <= reach);
                    expected += d.lo <= reach;
                }
            EXPECT_EQ(found.size(), expected);
            EXPECT_EQ(all.size(), expected);
            for (const Contact& c : all) {
                const Distance d = CertifiedDistance::distance(
                    tree_a.triangle(c.triangles.a, Pose{}), tree_b.triangle(c.triangles.b, pose));
                EXPECT_NEAR(length(c.normal), 1, 1e-12);
                ++(d.lo > 0 ? near : touching);
                if (d.lo > 0) {
                    EXPECT_NEAR(c.depth, -d.distance, 1e-12);
                    EXPECT_NEAR(dot(c.normal, d.point_b - d.point_a), d.distance, 1e-9);
                } else {
                    EXPECT_GE(c.depth, 0);
                }
            }
        }
    EXPECT_GT(near, 1000u);
    EXPECT_GT(touching, 100u);
    EXPECT_TRUE(near_triangles(tree_a, MeshTree(TriangleMesh{}), {}, 1).empty());
    EXPECT_THROW(near_triangles(tree_a, tree_b, {}, -1), std::invalid_argument);
    EXPECT_THROW(near_triangles(tree_a, tree_b, {}, std::nan("")), std::invalid_argument);
    for (const double margin : {-1.0, std::nan(""), 0x1p100}) {
        EXPECT_THROW(contacts(tree_a, tree_b, {}, {.margin = margin}), std::invalid_argument);
        EXPECT_THROW(contacts(tree_a, convex::Sphere{1}, {}, {.margin = margin}),
                     std::invalid_argument);
    }
}

/// Far from the origin, large and small: what all pairs say.
TEST(Contacts, NearTrianglesOfAllSizesAndPlaces) {
    for (const double scale : {0x1p-60, 1.0, 0x1p38})
        for (const double place : {0.0, 1e3, 1e6}) {
            TriangleMesh a = noisy_sphere(6, 7, .2, 1), b = noisy_sphere(5, 6, .2, 2);
            for (TriangleMesh* mesh : {&a, &b})
                for (Vec3<float>& v : mesh->vertices)
                    v = Vec3<float>(scale * (Vec3<double>(v) + Vec3<double>{place, 0, -place}));
            const MeshTree tree_a(a), tree_b(b);
            Pose pose;
            pose.translation = scale * Vec3<double>{1.9, .1, 0};
            for (const double reach : {1e-12, .05, .5}) {
                std::vector<Pair> found = near_triangles(tree_a, tree_b, pose, scale * reach);
                std::ranges::sort(found);
                std::vector<Pair> expected;
                for (std::uint32_t i = 0; i < tree_a.size(); ++i)
                    for (std::uint32_t j = 0; j < tree_b.size(); ++j)
                        if (CertifiedDistance::distance(tree_a.triangle(i, Pose{}),
                                                        tree_b.triangle(j, pose))
                                .lo <= scale * reach)
                            expected.push_back({i, j});
                EXPECT_EQ(found, expected) << scale << " " << place << " " << reach;
                EXPECT_TRUE(reach < .1 || expected.size() > 5);
            }
        }
}

TEST(Contacts, AMarginMakesTrianglesNearAShapeMeet) {
    const TriangleMesh mesh = noisy_sphere(12, 13, .2, 1);
    const MeshTree tree(mesh);
    const Pose pose{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {1.3, .1, 0}};
    for (const convex::Shape& shape :
         {convex::Shape(convex::Sphere{.4}), convex::Shape(convex::Cone{.4, .5}),
          convex::Shape(convex::Ellipsoid{{.3, .4, .5}}), convex::Shape(convex::Box{{.3, .3, .4}})})
        for (const double margin : {0.0, .05, .4}) {
            const std::vector<Contact> all = contacts(tree, shape, pose, {.margin = margin});
            std::size_t expected = 0;
            for (std::uint32_t i = 0; i < tree.size(); ++i)
                expected += convex::signed_distance(convex::Triangle(tree.triangle(i, Pose{})),
                                                    Pose{}, shape, pose)
                                .lo <= margin;
            EXPECT_EQ(all.size(), expected);
            EXPECT_GT(expected, margin == 0 ? 2u : 5u);
            for (const Contact& c : all) {
                const double distance =
                    convex::signed_distance(convex::Triangle(tree.triangle(c.triangles.a, Pose{})),
                                            Pose{}, shape, pose)
                        .distance;
                EXPECT_NEAR(c.depth, -distance, 1e-6);
            }
        }
}

TEST(Contacts, MovingByTheDepthPartsThem) {
    std::mt19937 random(3);
    const TriangleMesh a = noisy_sphere(8, 9, .2, 1), b = noisy_sphere(7, 8, .2, 2);
    const MeshTree tree_a(a), tree_b(b);
    std::size_t seen = 0;
    for (int k = 0; k < 10; ++k) {
        const Pose pose = random_pose(random, {1.4, .4, .2});
        const std::vector<Contact> all = contacts(tree_a, tree_b, pose);
        std::vector<Pair> pairs;
        for (const Contact& c : all) {
            pairs.push_back(c.triangles);
            EXPECT_NEAR(length(c.normal), 1, 1e-14);
            EXPECT_GE(c.depth, 0);
            Pose moved = pose;
            moved.translation = moved.translation + (c.depth + 1e-9) * c.normal;
            const MeshTree one_a({{a.triangle(c.triangles.a).a, a.triangle(c.triangles.a).b,
                                   a.triangle(c.triangles.a).c},
                                  {{0, 1, 2}}});
            const MeshTree one_b({{b.triangle(c.triangles.b).a, b.triangle(c.triangles.b).b,
                                   b.triangle(c.triangles.b).c},
                                  {{0, 1, 2}}});
            EXPECT_TRUE(collide(one_a, one_b, pose));
            EXPECT_FALSE(collide(one_a, one_b, moved));
            // The point is on both.
            const TriangleMesh at_point{{Vec3<float>(c.point)}, {{0, 0, 0}}};
            EXPECT_LT(distance(one_a, MeshTree(at_point), {}).hi, 1e-6);
            EXPECT_LT(distance(MeshTree(at_point), one_b, pose).hi, 1e-6);
        }
        std::ranges::sort(pairs);
        std::vector<Pair> expected = touching_triangles(tree_a, tree_b, pose);
        std::ranges::sort(expected);
        EXPECT_EQ(pairs, expected);
        EXPECT_TRUE(std::ranges::is_sorted(all, std::greater<>{}, &Contact::depth));
        seen += all.size();
        const std::vector<Contact> few = contacts(tree_a, tree_b, pose, {.max_contacts = 4});
        EXPECT_LE(few.size(), 4u);
        if (!all.empty()) {
            EXPECT_EQ(few.front().depth, all.front().depth);
        }
    }
    EXPECT_GT(seen, 50u);
}

TEST(Contacts, OfManyTheDeepestIsKeptAndThoseThatSpanTheMost) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Contact> all;
    for (std::uint32_t i = 0; i < 200; ++i)
        all.push_back({{unit(random), 2 * unit(random), 0}, {0, 0, 1}, unit(random), {i, 7 * i}});
    const auto key = [](const Contact& c) { return c.triangles.a; };
    for (const std::size_t count : {1u, 2u, 4u, 9u, 40u}) {
        std::set<std::uint32_t> expected, found;
        std::vector<Contact> chosen{*std::ranges::max_element(all, {}, &Contact::depth)};
        const auto nearest = [&](const Contact& c) {
            double least = std::numeric_limits<double>::infinity();
            for (const Contact& other : chosen)
                least = std::min(least, length(other.point - c.point));
            return least;
        };
        while (chosen.size() < count)
            chosen.push_back(*std::ranges::max_element(all, {}, nearest));
        for (const Contact& c : chosen)
            expected.insert(key(c));
        for (const Contact& c : deepest_first(all, {.max_contacts = count}))
            found.insert(key(c));
        EXPECT_EQ(found, expected);
        EXPECT_EQ(found.size(), count);
    }
    const std::vector<Contact> at_one_place(9, all.front());
    EXPECT_EQ(deepest_first(at_one_place, {.max_contacts = 4}).size(), 1u);
}

TEST(Contacts, OfTouchingAndDegenerateTrianglesAreFlat) {
    const Triangle<double> a{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const Contact face = contact_of(a, {{.2, .2, 0}, {1, 1, 2}, {0, 1, 2}});
    EXPECT_NEAR(face.depth, 0, 1e-15);
    const Contact same = contact_of(a, a);
    EXPECT_NEAR(same.depth, 0, 1e-15);
    EXPECT_NEAR(std::abs(same.normal.z), 1, 1e-15);
    const Contact point =
        contact_of({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    EXPECT_EQ(point.depth, 0);
    EXPECT_EQ(length(point.normal), 1);
    EXPECT_TRUE(contacts(MeshTree(), MeshTree(), {}).empty());
}

TEST(Solids, HoldWhatLiesInside) {
    const Solid outer(cube_mesh(1)), inner(cube_mesh(.1f, {.2f, .1f, 0}));
    EXPECT_TRUE(collide(outer, inner, {}));
    EXPECT_TRUE(collide(inner, outer, {}));
    Pose away;
    away.translation = {1.5, 0, 0};
    EXPECT_FALSE(collide(outer, inner, away));
    EXPECT_FALSE(collide(inner, outer, relative_pose(away, {})));
    EXPECT_FALSE(collide(Solid(TriangleMesh{}), inner, {}));
}

TEST(Solids, AreSoFarApartOrSoDeepInEachOther) {
    const Solid cube(cube_mesh(1)), small(cube_mesh(.1f, {.2f, .1f, 0}));
    const auto expect = [](const SolidDistance& found, double truth, double width) {
        EXPECT_LE(found.lo, truth);
        EXPECT_GE(found.hi, truth);
        EXPECT_LE(found.lo, found.distance);
        EXPECT_GE(found.hi, found.distance);
        EXPECT_LE(found.hi - found.lo, width);
    };
    const auto at = [](double x) { return Pose{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {x, 0, 0}}; };
    expect(signed_distance(cube, cube, at(3)), 1, 1e-9);
    expect(signed_distance(cube, cube, at(2)), 0, .036);
    expect(signed_distance(cube, cube, at(1.5)), -.5, .036);
    expect(signed_distance(cube, cube, at(1.5), .1), -.5, .1001);
    expect(signed_distance(cube, small, {}), -.9, .0036); // inside without a touch
    expect(signed_distance(small, cube, {}), -.9, .0036);
    const Pose turned =
        pose_of_matrix(std::array<double, 16>{0, -1, 0, 1.5, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    expect(signed_distance(cube, cube, turned), -.5, .036);
    const SolidDistance deep = signed_distance(cube, cube, at(1.5));
    EXPECT_NEAR(std::max(cube.depth_of(deep.point_a),
                         cube.depth_of(deep.point_a - Vec3<double>{1.5, 0, 0})),
                -deep.distance, 1e-6);
    // Of spheres: half of the lens's way in, which a surface's middle has.
    const Solid ball(noisy_sphere(60, 60, 0, 1));
    expect(signed_distance(ball, ball, at(1.2), .02), -.8, .06);
    EXPECT_EQ(signed_distance(cube, Solid(TriangleMesh{}), {}).distance,
              std::numeric_limits<double>::infinity());
    EXPECT_THROW(signed_distance(cube, cube, {}, -1), std::invalid_argument);
}

TEST(Solids, OfPartsAreLookedAtOneByOne) {
    // Far from the first part, the second one holds the small cube.
    TriangleMesh two = cube_mesh(1, {-10, 0, 0});
    const TriangleMesh other = cube_mesh(1, {10, 0, 0});
    for (const auto& [a, b, c] : other.triangles)
        two.triangles.push_back({a + 8, b + 8, c + 8});
    two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
    const Solid parts(two), small(cube_mesh(.1f));
    EXPECT_EQ(parts.parts(), 2u);
    Pose pose;
    EXPECT_FALSE(collide(parts, small, pose));
    for (const double x : {-10.0, 10.0}) {
        pose.translation = {x, 0, 0};
        EXPECT_TRUE(collide(parts, small, pose));
        EXPECT_TRUE(collide(small, parts, relative_pose(pose, {})));
    }
}

TEST(Solids, KeepPartsWhoseVerticesHaveUnusedTwins) {
    const TriangleMesh cube = cube_mesh(.1f);
    TriangleMesh doubled{cube.vertices, {}};
    doubled.vertices.insert(doubled.vertices.end(), cube.vertices.begin(), cube.vertices.end());
    for (const auto& [a, b, c] : cube.triangles)
        doubled.triangles.push_back({a + 8, b + 8, c + 8});
    EXPECT_TRUE(collide(Solid(cube_mesh(1)), Solid(doubled), {}));
    EXPECT_TRUE(collide(Solid(doubled), Solid(cube_mesh(1)), {}));
}

TEST(Solids, MustBeClosed) {
    TriangleMesh open = cube_mesh(1);
    open.triangles.pop_back();
    EXPECT_THROW(Solid{open}, std::invalid_argument);
}

TEST(Solids, HoldConvexShapes) {
    const Solid cube(cube_mesh(1));
    Pose aside;
    aside.translation = {.3, -.2, .1};
    const std::vector<Vec3<double>> points{{.1, 0, 0}, {0, .1, 0}, {0, 0, .1}, {0, 0, 0}};
    for (const convex::Shape& shape :
         {convex::Shape(convex::Sphere{.1}), convex::Shape(convex::Capsule{.1, .2}),
          convex::Shape(convex::Hull(points)), convex::Shape(convex::Cone{.1, .1})}) {
        aside.translation.x = .3;
        EXPECT_EQ(collide(cube.surface(), shape, aside).answer, Answer::no);
        EXPECT_EQ(collide(cube, shape, aside).answer, Answer::yes);
        aside.translation.x = .95; // through the surface
        EXPECT_EQ(collide(cube, shape, aside).answer, Answer::yes);
        aside.translation.x = 1.5;
        EXPECT_EQ(collide(cube, shape, aside).answer, Answer::no);
    }
    EXPECT_EQ(collide(cube, convex::Sphere{9}, aside).answer, Answer::yes); // it holds the cube
    EXPECT_EQ(collide(cube, convex::Plane{{0, 0, 1}, 3}, Pose{}).answer, Answer::no);
    EXPECT_EQ(collide(cube, convex::Plane{{0, 0, 1}, .5}, Pose{}).answer, Answer::yes);
}

} // namespace
} // namespace boxwood
