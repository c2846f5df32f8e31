#include "kernels/convex/contact.h"

#include "kernels/testing/posed_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace boxwood::convex {
namespace {

Pose at(double x, double y, double z) { return {Pose{}.rotation, {x, y, z}}; }

TEST(Contacts, OfABoxOnABoxAreTheCornersOfWhatTheyShare) {
    const Contacts c = contacts(Box{{1, 1, 1}}, Pose{}, Box{{1, 1, 1}}, at(.5, .25, 1.875));
    ASSERT_EQ(c.count, 4);
    EXPECT_EQ(c.distance.normal, (Vec3<double>{0, 0, 1}));
    double x = 0, y = 0;
    for (const ContactPoint& p : c.points) {
        EXPECT_NEAR(p.depth, .125, 1e-12);
        EXPECT_NEAR(p.point.z, .9375, 1e-14);
        EXPECT_NEAR(std::abs(p.point.x - .25), .75, 1e-14);
        EXPECT_NEAR(std::abs(p.point.y - .125), .875, 1e-14);
        x += p.point.x, y += p.point.y;
    }
    EXPECT_NEAR(x, 1, 1e-13);
    EXPECT_NEAR(y, .5, 1e-13);
}

TEST(Contacts, AreAllInBothShapesAndTheDeepestIsFirst) {
    RandomShapes shapes(1);
    int many = 0;
    for (int k = 0; k < 5000; ++k) {
        const PosedShape a = shapes.posed(ShapeKind::box, .7), b = shapes.posed(ShapeKind::box, .7);
        const Contacts c = contacts(a.shape, a.pose, b.shape, b.pose);
        if (c.distance.distance > 0) {
            EXPECT_EQ(c.count, 0);
            continue;
        }
        ASSERT_GE(c.count, 1);
        many += c.count > 2;
        EXPECT_NEAR(c.points[0].depth, -c.distance.distance, 1e-6);
        for (int i = 0; i < c.count; ++i) {
            const ContactPoint& p = c.points[static_cast<std::size_t>(i)];
            EXPECT_LE(p.depth, c.points[static_cast<std::size_t>(std::max(i - 1, 0))].depth);
            EXPECT_GE(p.depth, 0);
            const Sphere point{0};
            for (const PosedShape& s : {a, b})
                EXPECT_LE(signed_distance(point, {{}, p.point}, s.shape, s.pose).distance,
                          p.depth + 1e-7);
        }
    }
    EXPECT_GT(many, 100);
}

TEST(Contacts, OfWhatLiesOnAFlatAreItsCorners) {
    const HalfSpace floor{{0, 0, 2}, 0}; // z <= 0
    const auto count = [&](const Shape& s, double z) {
        const Contacts c = contacts(s, at(5, 6, z), floor, Pose{});
        for (int i = 0; i < c.count; ++i) {
            const ContactPoint& p = c.points[static_cast<std::size_t>(i)];
            EXPECT_NEAR(p.depth, .125, 1e-12) << to_string(s.kind());
            EXPECT_GE(p.depth, .125 - 1e-14); // rounding goes to the safe side
            EXPECT_NEAR(p.point.z, -.0625, 1e-14);
        }
        return c.count;
    };
    EXPECT_EQ(count(Box{{1, 2, 1}}, .875), 4);
    EXPECT_EQ(count(Cylinder{1, 1}, .875), 4);
    EXPECT_EQ(count(Cone{1, 1}, .875), 4);
    EXPECT_EQ(count(Capsule{1, 1}, 1.875), 1); // it stands
    EXPECT_EQ(count(Sphere{1}, .875), 1);
    const std::vector<Vec3<double>> corners{{0, 0, -1}, {1, 0, -1},   {0, 1, -1},
                                            {1, 1, -1}, {.5, .5, -1}, {0, 0, 3}};
    EXPECT_EQ(count(Hull(corners), .875), 4);
    EXPECT_EQ(contacts(Box{{1, 2, 1}}, at(0, 0, 1.5), floor, Pose{}).count, 0);
    EXPECT_EQ(contacts(Box{{1, 2, 1}}, at(0, 0, 1.5), floor, Pose{}, .5).count, 4);
}

TEST(Contacts, OnAFlatAreOfTheShapeDeepestFirstAndTheSameFromBothSides) {
    RandomShapes shapes(4);
    int many = 0;
    for (const ShapeKind kind : {ShapeKind::box, ShapeKind::hull, ShapeKind::capsule,
                                 ShapeKind::cylinder, ShapeKind::cone, ShapeKind::triangle})
        for (int k = 0; k < 1000; ++k) {
            const PosedShape s = shapes.posed(kind, 1);
            const PosedShape flat =
                shapes.posed(k % 2 ? ShapeKind::plane : ShapeKind::half_space, .5);
            const Contacts c = contacts(s.shape, s.pose, flat.shape, flat.pose),
                           back = contacts(flat.shape, flat.pose, s.shape, s.pose);
            ASSERT_EQ(c.count, back.count);
            if (c.count == 0)
                continue;
            many += c.count > 1;
            EXPECT_NEAR(c.points[0].depth, -c.distance.distance, 1e-9) << to_string(kind);
            for (int i = 0; i < c.count; ++i) {
                const ContactPoint &p = c.points[static_cast<std::size_t>(i)],
                                   &q = back.points[static_cast<std::size_t>(i)];
                EXPECT_EQ(p.depth, q.depth);
                EXPECT_LE(p.depth, c.points[static_cast<std::size_t>(std::max(i - 1, 0))].depth);
                EXPECT_GE(p.depth, 0);
                // Half its depth along the normal it is in the shape, half its depth back on the
                // flat.
                const Pose in_shape{Pose{}.rotation, p.point + c.distance.normal * (p.depth / 2)},
                    on_flat{Pose{}.rotation, p.point - c.distance.normal * (p.depth / 2)};
                const Sphere point{0};
                EXPECT_LE(signed_distance(point, in_shape, s.shape, s.pose).distance, 1e-9)
                    << to_string(kind);
                EXPECT_NEAR(signed_distance(point, on_flat, flat.shape, flat.pose).distance, 0,
                            1e-9);
            }
        }
    EXPECT_GT(many, 1000);
}

TEST(Contacts, OfDeepRoundShapesAreAsDeepAsPartsThem) {
    const Contacts c = contacts(Capsule{.25, .5}, Pose{}, Cylinder{.5, .5}, Pose{});
    ASSERT_EQ(c.count, 1);
    EXPECT_GE(c.points[0].depth, .75);
    EXPECT_LT(c.points[0].depth, .76);
}

TEST(Contacts, OfOtherShapesAreOnePoint) {
    const Contacts c = contacts(Sphere{1}, Pose{}, Sphere{1}, at(0, 1.5, 0));
    ASSERT_EQ(c.count, 1);
    EXPECT_NEAR(c.points[0].depth, .5, 1e-12); // and no less than surely parts them
    EXPECT_GE(c.points[0].depth, .5);
    EXPECT_NEAR(c.points[0].point.y, .75, 1e-14);
    EXPECT_EQ(contacts(Sphere{1}, Pose{}, Sphere{1}, at(0, 3, 0)).count, 0);
    EXPECT_EQ(contacts(Sphere{1}, Pose{}, Sphere{1}, at(0, 3, 0), 1.5).count, 1);
}

} // namespace
} // namespace boxwood::convex
