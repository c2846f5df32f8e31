#include "kernels/convex/contact.h"

#include "kernels/testing/posed_shapes.h"

#include <gtest/gtest.h>

namespace boxwood::convex {
namespace {

Pose at(double x, double y, double z) { return {Pose{}.rotation, {x, y, z}}; }

TEST(Contacts, OfABoxOnABoxAreTheCornersOfWhatTheyShare) {
    const Contacts c = contacts(Box{{1, 1, 1}}, Pose{}, Box{{1, 1, 1}}, at(.5, .25, 1.875));
    ASSERT_EQ(c.count, 4);
    EXPECT_EQ(c.distance.normal, (Vec3<double>{0, 0, 1}));
    double x = 0, y = 0;
    for (const ContactPoint& p : c.points) {
        EXPECT_NEAR(p.depth, .125, 1e-14);
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
            EXPECT_LE(p.depth, c.points[0].depth);
            EXPECT_GE(p.depth, 0);
            const Sphere point{0};
            for (const PosedShape& s : {a, b})
                EXPECT_LE(signed_distance(point, {{}, p.point}, s.shape, s.pose).distance,
                          p.depth + 1e-7);
        }
    }
    EXPECT_GT(many, 100);
}

TEST(Contacts, OfOtherShapesAreOnePoint) {
    const Contacts c = contacts(Sphere{1}, Pose{}, Sphere{1}, at(0, 1.5, 0));
    ASSERT_EQ(c.count, 1);
    EXPECT_NEAR(c.points[0].depth, .5, 1e-14);
    EXPECT_NEAR(c.points[0].point.y, .75, 1e-14);
    EXPECT_EQ(contacts(Sphere{1}, Pose{}, Sphere{1}, at(0, 3, 0)).count, 0);
    EXPECT_EQ(contacts(Sphere{1}, Pose{}, Sphere{1}, at(0, 3, 0), 1.5).count, 1);
}

} // namespace
} // namespace boxwood::convex
