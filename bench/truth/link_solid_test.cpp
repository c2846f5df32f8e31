#include "bench/truth/link_solid.h"

#include "kernels/oracle/oracle.h"

#include <gtest/gtest.h>

#include <random>

namespace boxwood::bench {
namespace {

/// How often a ray from p, almost along x, meets the surface: an odd number of times from within.
bool is_within(const PosedTriangles& surface, Vec3<double> p) {
    const Vec3<double> far{p.x + 100, p.y + .00123, p.z + .00077};
    const Triangle<double> ray{p, far, far};
    int crossings = 0;
    for (const Triangle<double>& t : surface)
        crossings += overlaps(t.bounds(), ray.bounds()) && oracle::intersect(t, ray);
    return crossings % 2 == 1;
}

/// What is in the inner polyhedron is in the shape; what is in the shape is in the outer one.
void expect_between(const LinkShape& shape, double reach) {
    const LinkSolid solid = link_solid({shape, {}}, {});
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-reach, reach);
    int inner = 0, between = 0, outer = 0;
    for (int i = 0; i < 400; ++i) {
        const Vec3<double> p{place(random), place(random), place(random)};
        if (is_within(solid.inner, p)) {
            ++inner;
            EXPECT_LE(solid.level(p), 1 + 1e-12);
            EXPECT_TRUE(solid.may_contain(p));
        } else if (is_within(solid.outer, p)) {
            ++between;
            EXPECT_TRUE(solid.may_contain(p));
        } else {
            ++outer;
            EXPECT_FALSE(solid.contains(p));
        }
    }
    EXPECT_GT(inner, 40);
    EXPECT_GT(outer, 40);
    EXPECT_LT(between, 20);
    for (const Triangle<double>& t : solid.inner)
        for (const Vec3<double> p : {t.a, t.b, t.c})
            EXPECT_LE(solid.level(p), 1 + 1e-12);
    for (const Triangle<double>& t : solid.outer)
        for (const Vec3<double> p : {t.a, t.b, t.c}) {
            EXPECT_GE(solid.level(p), 1 - 1e-12);
            EXPECT_LE(solid.level(p), solid.outer_level);
        }
}

TEST(LinkSolid, LiesBetweenTwoPolyhedra) {
    expect_between(LinkBox{{1, 2, 3}}, 1.6);
    expect_between(LinkSphere{.7}, .9);
    expect_between(LinkCylinder{.7, 1}, .9);
    expect_between(LinkCapsule{.5, 1}, 1.1);
}

TEST(LinkSolid, OfAMeshIsItsSurfaceScaled) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const LinkSolid solid = link_solid({LinkMesh{0, {2, -3, 1}}, {}}, {mesh});
    ASSERT_EQ(solid.inner.size(), 1u);
    EXPECT_EQ(solid.inner[0].c, (Vec3<double>{0, -3, 0}));
    EXPECT_FALSE(solid.may_contain({0, 0, 0}));
}

} // namespace
} // namespace boxwood::bench
