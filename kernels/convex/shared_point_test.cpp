#include "kernels/convex/shared_point.h"

#include "kernels/testing/posed_shapes.h"
#include "kernels/triangle_distance/certified.h"

#include <gtest/gtest.h>

namespace boxwood::convex {
namespace {

/// Held against distances of that point: from the shape, and from the triangle by the kernel of
/// triangles, where it is one whose corners are alike.
TEST(SharedPoint, IsOfBothWhereTheyTouch) {
    RandomShapes shapes(31);
    int touching = 0, apart = 0;
    for (std::size_t kind = 0; kind < shape_kinds; ++kind)
        for (int k = 0; k < 200; ++k) {
            const PosedShape b = shapes.posed(static_cast<ShapeKind>(kind), .6);
            const Triangle t{shapes.random.vector(1), shapes.random.vector(1),
                             shapes.random.vector(1)};
            const Pose pose{shapes.random.rotation(), shapes.random.vector(.4)};
            const SignedDistance d = signed_distance(t, pose, b.shape, b.pose);
            const Vec3<double> p = shared_point(t, pose, b.shape, b.pose);
            const Triangle world{pose(t.a), pose(t.b), pose(t.c)};
            EXPECT_LT(CertifiedDistance::distance({p, p, p}, world).hi, 1e-13)
                << to_string(b.shape.kind());
            const SignedDistance to_shape =
                signed_distance(Sphere{0}, {.translation = p}, b.shape, b.pose);
            if (d.hi <= 0) {
                ++touching;
                EXPECT_LT(to_shape.lo, 1e-13) << to_string(b.shape.kind());
            } else if (d.lo > 1e-6) {
                ++apart;
                EXPECT_NEAR(to_shape.distance, d.distance, 1e-5) << to_string(b.shape.kind());
            }
        }
    EXPECT_GT(touching, 400);
    EXPECT_GT(apart, 200);
}

TEST(SharedPoint, OfATriangleOnAFaceOrThroughAPlane) {
    const Triangle across{{0, 0, -1}, {4, 0, -1}, {0, 0, 3}};
    EXPECT_NEAR(shared_point(across, {}, Plane{{0, 0, 2}, 2}, {}).z, 1, 1e-15);
    EXPECT_EQ(shared_point(across, {}, HalfSpace{{0, 0, 1}, 0}, {}).z, -1);
    const Triangle on_top{{-3, -3, 1}, {3, -3, 1}, {0, 3, 1}};
    const Vec3<double> p = shared_point(on_top, {}, Box{{1, 1, 1}}, {});
    EXPECT_LE(std::abs(p.x), 1 + 1e-14);
    EXPECT_LE(std::abs(p.y), 1 + 1e-14);
    EXPECT_NEAR(p.z, 1, 1e-14);
}

} // namespace
} // namespace boxwood::convex
