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

/// Doubles leave out only what rationals say is apart: triangles of any shape, barely above or
/// below, in one plane, large, small, far away.
TEST(LinkSolid, SurfacesTouchAsRationalsSay) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-1, 1);
    const auto point = [&] { return Vec3<double>{place(random), place(random), place(random)}; };
    const auto surface = [](const Triangle<double>& t) {
        LinkSolid solid;
        solid.inner = solid.outer = {t};
        return solid;
    };
    int touching = 0, apart = 0;
    for (int k = 0; k < 6000; ++k) {
        const Triangle<double> s{point(), point(), point()};
        Triangle<double> t{point(), point(), point()};
        if (k % 3 == 1) { // a corner on s, an edge or a corner of it, as doubles place it
            const double u = k % 2 ? .25 : 0, v = k % 5 ? .5 : 0;
            t.a = s.a + u * (s.b - s.a) + v * (s.c - s.a);
        } else if (k % 3 == 2) { // a needle or a point near the plane of s
            t.a = .5 * (s.a + s.b) + 0x1p-53 * t.a;
            t.b = t.a + 0x1p-40 * t.b;
            t.c = k % 2 ? t.a : t.c;
        }
        const double scale = k % 4 == 0 ? 0x1p90 : k % 4 == 1 ? 0x1p-320 : 1;
        const Vec3<double> far = k % 7 ? Vec3<double>{} : scale * 1e6 * point();
        const auto placed = [&](Triangle<double> of) {
            return Triangle<double>{scale * of.a + far, scale * of.b + far, scale * of.c + far};
        };
        const LinkSolid a = surface(placed(s)), b = surface(placed(t));
        const bool expected = oracle::intersect(a.inner[0], b.inner[0]);
        EXPECT_EQ(surely_touch({a, {}}, {b, {}}), expected) << k;
        EXPECT_EQ(may_touch({b, {}}, {a, {}}), expected) << k;
        ++(expected ? touching : apart);
    }
    EXPECT_GT(touching, 1000);
    EXPECT_GT(apart, 1000);
}

} // namespace
} // namespace boxwood::bench
