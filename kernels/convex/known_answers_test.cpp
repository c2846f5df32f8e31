// What is known without computing: hard cases of primitives, symmetric poses, flat and empty
// shapes.

#include "kernels/convex/detail/ellipsoid_foot.h"
#include "kernels/convex/signed_distance.h"
#include "kernels/testing/poses.h"

#include <gtest/gtest.h>

#include <limits>

namespace boxwood::convex {
namespace {

Pose at(double x, double y, double z) { return {Pose{}.rotation, {x, y, z}}; }

void expect_distance(const SignedDistance& d, double truth, double slack = 5e-13) {
    EXPECT_LE(d.lo, truth);
    EXPECT_GE(d.hi, truth);
    EXPECT_NEAR(d.distance, truth, slack);
    EXPECT_LE(d.hi - d.lo, 2 * slack);
    EXPECT_NEAR(length((d.point_b - d.point_a) - d.normal * d.distance), 0, 1e-5);
}

TEST(KnownAnswers, BoxesAlongEveryAxis) { // FCL says sqrt(10) for 3, and so on
    const Box unit{{.5, .5, .5}};
    for (int axis = 0; axis < 3; ++axis)
        for (int k = -60; k <= 60; ++k) {
            Pose pose{};
            pose.translation[axis] = k / 8.0;
            expect_distance(signed_distance(unit, Pose{}, unit, pose), std::abs(k) / 8.0 - 1);
        }
    expect_distance(signed_distance(unit, at(0, 4, 0), unit, Pose{}), 3);
}

TEST(KnownAnswers, NormalsOfAnyLength) {
    for (const double scale :
         {0x1p-1074, 1e-320, 1e-170, 1e-162, 1e-155, 1., 1.5e154, 1e160, 1e308})
        for (const double sign : {1., -1.}) {
            SCOPED_TRACE(sign * scale);
            // All of x >= 5, or x <= -5, and where the offset says so instead of the pose.
            const Vec3<double> normal{-sign * scale, 0, 0};
            const Sphere ball{1};
            expect_distance(signed_distance(HalfSpace{normal, 0}, at(sign * 5, 0, 0), ball, Pose{}),
                            4);
            expect_distance(signed_distance(Plane{normal, 0}, at(sign * 5, 0, 0), ball, Pose{}), 4);
            EXPECT_EQ(collide(ball, Pose{}, HalfSpace{normal, 0}, at(sign * 5, 0, 0)).answer,
                      Answer::no);
            EXPECT_EQ(collide(ball, Pose{}, HalfSpace{normal, 0}, at(sign, 0, 0)).answer,
                      Answer::maybe);
            if (scale < 1e307)
                expect_distance(
                    signed_distance(HalfSpace{normal, -5 * scale}, Pose{}, Box{{1, 1, 1}}, Pose{}),
                    4);
            const SignedDistance flats = signed_distance(HalfSpace{normal, 0}, at(sign * 5, 0, 0),
                                                         Plane{-normal, 0}, Pose{});
            EXPECT_NEAR(flats.distance, 5, 1e-14);
        }
}

TEST(KnownAnswers, ASphereOnTheAxisOfACapsuleLeavesItSideways) {
    RandomPoses random(3);
    for (int i = 0; i < 2000; ++i) {
        const Capsule rod{.5, 1};
        Pose pose{random.rotation(), random.vector(i % 2 == 0 ? 0 : 2)};
        if (i < 2)
            pose.rotation = {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}}; // along x
        const Vec3<double> axis{pose.rotation[0].z, pose.rotation[1].z, pose.rotation[2].z};
        const double along = i < 4 ? 0 : (i % 21 - 10) / 10.; // to the very ends
        const double off = i % 5 == 0 ? 0x1p-30 : 0;
        const Sphere ball{.5};
        Pose at_ball{Pose{}.rotation, pose.translation + axis * along + Vec3<double>{off, off, 0}};
        const SignedDistance d = signed_distance(ball, at_ball, rod, pose);
        EXPECT_NEAR(d.distance, -1, 1e-8);
        // B leaves A along the normal, and A leaves B against it.
        Pose moved = pose;
        moved.translation = moved.translation - d.normal * d.distance;
        EXPECT_GE(signed_distance(ball, at_ball, rod, moved).hi, -1e-12) << i;
        const SignedDistance other = signed_distance(rod, pose, ball, at_ball);
        at_ball.translation = at_ball.translation - other.normal * other.distance;
        EXPECT_GE(signed_distance(rod, pose, ball, at_ball).hi, -1e-12) << i;
    }
}

TEST(KnownAnswers, BoxesAcrossEdgesAndCorners) {
    const Box unit{{.5, .5, .5}};
    expect_distance(signed_distance(unit, Pose{}, unit, at(4, 5, 0)), 5);
    expect_distance(signed_distance(unit, Pose{}, unit, at(3, 3, 2)), 3);
    expect_distance(signed_distance(unit, Pose{}, unit, at(.75, .5, .25)), -.25);
    expect_distance(signed_distance(Box{{1, 1, 1}}, Pose{}, Box{{.1, .1, .1}}, at(.2, .1, 0)),
                    -.9); // hard case 12: inside
}

TEST(KnownAnswers, KissingBoxes) {
    const std::array<Vec3<double>, 3> r{
        {{.96193976625564348026, .15401279915737359216, .22572537250328919556},
         {-.19134171618254486313, .96936494951283913579, .15401279915737359216},
         {-.19509032201612822033, -.19134171618254486313, .96193976625564348026}}};
    const Vec3<double> p1{2.0770063995786869349, .48468247475641951239, 1.1543291419087275962},
        p2{2, 0, 1.25};
    const Box half{{.25, .25, .25}};
    const SignedDistance d = signed_distance(half, {r, p1}, half, {r, p2});
    EXPECT_LT(std::abs(d.distance), 1e-12);
    EXPECT_LE(d.lo, d.hi);
    EXPECT_LT(d.hi - d.lo, 1e-12);
    for (const double dim : {.01, .25, .5, 10.0, 1000.0})
        for (const double gap : {0.0, 1e-16, -1e-16, 2.5e-16, -2.5e-16, 1e-15, -1e-15}) {
            const double s = std::max(1.0, dim);
            const Box box{{dim / 2, dim / 2, dim / 2}};
            // One on the other along a column of R, the distance of their centres rounded.
            const Vec3<double> up{r[0].y, r[1].y, r[2].y};
            const Vec3<double> p3 = p2 + up * (dim + gap * s);
            const SignedDistance e = signed_distance(box, {r, p2}, box, {r, p3});
            EXPECT_LT(std::abs(e.distance), 1e-13 * s);
            EXPECT_LT(e.hi - e.lo, 1e-12 * s);
        }
}

TEST(KnownAnswers, RoundShapesOnAnAxis) {
    const Sphere ball{1};
    expect_distance(signed_distance(ball, Pose{}, ball, at(3, 4, 0)), 3);
    expect_distance(signed_distance(ball, Pose{}, ball, Pose{}), -2);
    expect_distance(signed_distance(ball, at(0, 0, 5), Capsule{1, 2}, Pose{}), 1);
    expect_distance(signed_distance(ball, at(5, 0, 1), Cylinder{2, 2}, Pose{}), 2);
    expect_distance(signed_distance(ball, at(5, 0, 6), Cylinder{2, 2}, Pose{}), 4);
    expect_distance(signed_distance(ball, Pose{}, Cylinder{2, 3}, Pose{}), -3);
    expect_distance(signed_distance(ball, at(0, 0, 6), Cone{3, 2}, Pose{}), 3);
    expect_distance(signed_distance(ball, at(0, 0, -6), Cone{3, 2}, Pose{}), 3);
    expect_distance(signed_distance(ball, at(6, 0, -6), Cone{3, 2}, Pose{}), 4);
    // Slant of a 3-4-5 triangle: from (0, 2) to (3, -2); beside its middle by 5.
    expect_distance(signed_distance(ball, at(1.5 + 4, 0, 3), Cone{3, 2}, Pose{}), 4);
    expect_distance(signed_distance(Capsule{.5, 2}, Pose{}, Capsule{.5, 2}, at(0, 3, 1)), 2);
    expect_distance(signed_distance(ball, at(0, 9, 0), Ellipsoid{{1, 2, 3}}, Pose{}), 6);
    expect_distance(signed_distance(Cylinder{1, 2}, Pose{}, Cylinder{1, 2}, at(5, 0, 0)), 3, 1e-9);
    expect_distance(signed_distance(Cylinder{1, 2}, Pose{}, Cylinder{1, 2}, at(0, 0, 5)), 1, 1e-9);
    expect_distance(signed_distance(Cone{1, 2}, Pose{}, Box{{1, 1, 1}}, at(0, 0, 4)), 1, 1e-9);
}

TEST(KnownAnswers, RoundShapesInOneAnotherHaveBoundsThatHold) {
    // Many directions are alike: the bounds may be wide, but hold.
    const auto within_bounds = [](const SignedDistance& d, double truth) {
        EXPECT_LE(d.lo, truth);
        EXPECT_GE(d.hi, truth);
        EXPECT_LE(d.hi - d.lo, .2 * std::abs(truth));
    };
    within_bounds(signed_distance(Cylinder{1, 2}, Pose{}, Cylinder{1, 2}, Pose{}), -2);
    within_bounds(signed_distance(Ellipsoid{{1, 1, 1}}, Pose{}, Ellipsoid{{2, 2, 2}}, Pose{}), -3);
    within_bounds(signed_distance(Cone{1, 9}, Pose{}, Sphere{1}, at(0, 0, -5)),
                  -1 - 14 / std::sqrt(18 * 18 + 1));
    EXPECT_EQ(collide(Ellipsoid{{1, 1, 1}}, Pose{}, Ellipsoid{{2, 2, 2}}, Pose{}).answer,
              Answer::yes);
}

Vec3<double> times_each(Vec3<double> a, Vec3<double> b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// A point, and how far it is from an ellipsoid, up to rounding.
struct Beside {
    Vec3<double> radii, on, normal;
    double distance;
    Vec3<double> point() const { return on + normal * distance; }
    double size() const { return 2 * std::max({radii.x, radii.y, radii.z}) + std::abs(distance); }
};

/// Beside a random point of the surface, or one in a plane of symmetry or near it. Inside no deeper
/// than the least radius of curvature, beyond which another point may be nearer.
Beside draw_beside(Vec3<double> radii, int i, RandomPoses& random) {
    constexpr double off_plane[] = {0, 1e-5, 1e-9, 1e-14, 1e-30, 1e-310};
    Vec3<double> t = random.unit_vector();
    if (i % 7 < 3)
        t[i % 7] = off_plane[i / 7 % 6];
    t = t * (1 / length(t));
    Vec3<double> n{t.x / radii.x, t.y / radii.y, t.z / radii.z};
    n = n * (1 / std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}));
    const double least = std::min({radii.x, radii.y, radii.z}),
                 most = std::max({radii.x, radii.y, radii.z});
    return {radii, times_each(radii, t), n * (1 / length(n)),
            i / 42 % 2 == 0 ? std::exp2(i % 40 - 30) : -least * (least / most) * (i % 100) / 100};
}

constexpr Vec3<double> radii_of_ellipsoids[] = {
    {1, 1, 1},         {1, 2, 3},     {3, 2, 1},     {2, 2, 1},       {1, 2, 2},
    {1, 1e-3, 1},      {1e-6, 1, 2},  {1, 1, 1e-8},  {1, 1e-9, 1},    {1, 1e-9, 1e-5},
    {1e-12, 1e-12, 1}, {1e-17, 1, 2}, {1e6, 1e6, 1}, {1e-20, 1, 1.5}, {1e-170, 1, 1}};

TEST(KnownAnswers, ASphereLeavesAnEllipsoidByItsNearestPoint) {
    RandomPoses random(5);
    for (const Vec3<double> radii : radii_of_ellipsoids)
        for (int i = 0; i < 3000; ++i) {
            SCOPED_TRACE(testing::Message()
                         << radii.x << ' ' << radii.y << ' ' << radii.z << ' ' << i);
            const Beside c = draw_beside(radii, i, random);
            const double radius = i % 3 * .25, truth = c.distance - radius;
            const Pose frame = i % 4 == 0 ? Pose{} : Pose{random.rotation(), random.vector(1)};
            const SignedDistance found = signed_distance(
                Sphere{radius}, {Pose{}.rotation, frame(c.point())}, Ellipsoid{radii}, frame);
            const double size = c.size() + 2;
            EXPECT_LE(found.lo, truth + 2e-15 * size);
            EXPECT_GE(found.hi, truth - 2e-15 * size);
            EXPECT_LE(found.hi - found.lo, 1e-13 * size);
            EXPECT_NEAR(found.distance, truth, 5e-15 * size);
            EXPECT_NEAR(length(found.point_b - frame(c.on)), 0, 1e-6 * size);
        }
}

/// Wherever the search ends, the bounds hold: they are no closer than the root's.
TEST(KnownAnswers, TheFootOnAnEllipsoidHasBoundsForAnyMultiplier) {
    RandomPoses random(8);
    int wide = 0;
    for (const Vec3<double> radii : radii_of_ellipsoids)
        for (int i = 0; i < 500; ++i) {
            const Beside c = draw_beside(radii, i, random);
            detail::EllipsoidFoot search(c.point(), radii);
            const double start = search.shift;
            search.solve();
            const double root = search.shift;
            for (const double part : {0., 1e-9, 1e-3, .5, .999, 1., 1.001, 2., 1e3}) {
                search.shift = part == 0 ? start : root * part;
                const detail::Foot foot = search.foot();
                const double slack = 4e-15 * c.size();
                EXPECT_LE(foot.distance - foot.width, c.distance + slack) << part << ' ' << i;
                EXPECT_GE(foot.distance + foot.width, c.distance - slack) << part << ' ' << i;
                wide += foot.width > 1e-6 * c.size();
            }
        }
    EXPECT_GT(wide, 5000); // else it were a test of the root
}

/// A power of two rounds nothing: all scales.
TEST(KnownAnswers, TheFootOnAnEllipsoidScales) {
    RandomPoses random(9);
    for (int i = 0; i < 2000; ++i) {
        const Beside c = draw_beside({1, 1 + i % 3 * .5, std::exp2(-(i % 5))}, i % 1000, random);
        const SignedDistance one =
            signed_distance(Sphere{.25}, {Pose{}.rotation, c.point()}, Ellipsoid{c.radii}, Pose{});
        for (const double scale : {0x1p-96, 0x1p90}) {
            const SignedDistance d =
                signed_distance(Sphere{.25 * scale}, {Pose{}.rotation, c.point() * scale},
                                Ellipsoid{c.radii * scale}, Pose{});
            EXPECT_NEAR(d.distance, one.distance * scale, 1e-15 * scale * c.size());
            EXPECT_NEAR(d.hi - d.lo, (one.hi - one.lo) * scale, 1e-15 * scale * c.size());
        }
    }
}

TEST(KnownAnswers, ASphereDeepInAnEllipsoidHasSharpBounds) {
    RandomPoses random(6);
    for (int i = 0; i < 400; ++i) {
        const Vec3<double> radii{std::exp2(i % 5), i % 3 == 0 ? 1 : std::exp2(-(i % 4)), 1};
        Vec3<double> p = times_each(radii, random.unit_vector()) * (i % 10 / 10.);
        if (i % 2 == 0)
            p[i % 3] = i % 4 == 0 ? 0 : 1e-310; // two points are as near
        const SignedDistance d =
            signed_distance(Sphere{.5}, {Pose{}.rotation, p}, Ellipsoid{radii}, Pose{});
        EXPECT_LE(d.hi - d.lo, 2e-13 * std::max(radii.x, 1.0)) << i;
        for (int k = 0; k < 2000; ++k) {
            const Vec3<double> n = random.unit_vector(), on = times_each(radii, n);
            EXPECT_LE(dot(n, p) - length(on) - .5, d.hi) << i; // no direction is a shorter way out
            EXPECT_GE(length(p - on), -(d.hi + .5)) << i;      // and no point of the surface nearer
        }
        const Vec3<double> on = d.point_b;
        EXPECT_NEAR(length(Vec3<double>{on.x / radii.x, on.y / radii.y, on.z / radii.z}), 1, 1e-14);
        EXPECT_NEAR(length(on - p), -(d.distance + .5), 1e-13 * std::max(radii.x, 1.0)) << i;
    }
    expect_distance(signed_distance(Sphere{1}, Pose{}, Ellipsoid{{2, 3, 4}}, Pose{}), -3);
    expect_distance(signed_distance(Sphere{1}, Pose{}, Ellipsoid{{2, 2, 2}}, Pose{}), -3);
    // Near the rim of a plate, where the term of the least radius is a spike.
    const SignedDistance rim = signed_distance(Sphere{.25}, at(0.999999999999999, 0, 1e-14),
                                               Ellipsoid{{1, 1, 1e-8}}, Pose{});
    EXPECT_LE(rim.hi - rim.lo, 1e-13);
    // Flat ones: a disc, a rod, a point.
    expect_distance(signed_distance(Sphere{1}, at(.25, .25, 3), Ellipsoid{{1, 1, 0}}, Pose{}), 2);
    expect_distance(signed_distance(Sphere{1}, at(.25, .25, 0), Ellipsoid{{1, 1, 0}}, Pose{}), -1);
    expect_distance(signed_distance(Sphere{1}, at(4, 0, 4), Ellipsoid{{1, 1, 0}}, Pose{}), 4);
    expect_distance(signed_distance(Sphere{1}, at(.5, 3, 4), Ellipsoid{{1, 0, 0}}, Pose{}), 4);
    expect_distance(signed_distance(Sphere{1}, at(4, 4, 0), Ellipsoid{{1, 0, 0}}, Pose{}), 4);
    expect_distance(signed_distance(Sphere{1}, at(0, 3, 4), Ellipsoid{{0, 0, 0}}, Pose{}), 4);
}

TEST(KnownAnswers, FlatAndEmptyShapes) {
    const Box plate{{1, 1, 0}}, stick{{0, 0, 1}}, point{{0, 0, 0}};
    expect_distance(signed_distance(plate, Pose{}, plate, at(0, 0, 2)), 2);
    expect_distance(signed_distance(plate, Pose{}, plate, at(.5, .5, 0)), 0);
    expect_distance(signed_distance(plate, Pose{}, stick, at(.25, .125, .5)), -.5);
    expect_distance(signed_distance(point, Pose{}, point, at(3, 4, 0)), 5);
    expect_distance(signed_distance(point, Pose{}, point, Pose{}), 0);
    expect_distance(signed_distance(Sphere{0}, at(1, 1, 1), Sphere{0}, at(1, 1, 1)), 0);
    expect_distance(signed_distance(Sphere{0}, at(1, 0, 0), Triangle{}, Pose{}), 1);
    expect_distance(signed_distance(Cylinder{1, 0}, Pose{}, Cylinder{1, 0}, at(3, 0, 0)), 1, 1e-9);
    expect_distance(signed_distance(Capsule{1, 0}, Pose{}, Capsule{0, 3}, at(0, 4, 0)), 3);
    expect_distance(signed_distance(Capsule{0, 1}, Pose{}, Capsule{0, 1}, Pose{}), 0);
    for (const double by : {.001, .25}) { // a disk, and a rod: nothing is inside
        expect_distance(signed_distance(Cone{.25, 0}, Pose{}, Sphere{by}, at(1, 0, 0)), .75 - by);
        expect_distance(signed_distance(Cone{.25, 0}, Pose{}, Sphere{by}, at(.125, 0, 3)), 3 - by);
        expect_distance(signed_distance(Cone{.25, 0}, Pose{}, Sphere{by}, at(.125, 0, 0)), -by);
        expect_distance(signed_distance(Cone{0, .5}, Pose{}, Sphere{by}, at(0, 0, 3)), 2.5 - by);
        expect_distance(signed_distance(Cone{0, .5}, Pose{}, Sphere{by}, at(0, 0, -3)), 2.5 - by);
        expect_distance(signed_distance(Cone{0, .5}, Pose{}, Sphere{by}, at(2, 0, .25)), 2 - by);
        expect_distance(signed_distance(Cone{0, .5}, Pose{}, Sphere{by}, at(0, 0, .25)), -by);
    }
    const std::array<Vec3<double>, 1> one{{{0, 0, 7}}};
    expect_distance(signed_distance(Hull(one), Pose{}, Box{{1, 1, 1}}, Pose{}), 6);
    const std::array<Vec3<double>, 5> twice{
        {{0, 0, 3}, {0, 0, 3}, {1, 0, 3}, {0, 1, 3}, {0, 1, 3}}};
    expect_distance(signed_distance(Hull(twice), Pose{}, Box{{1, 1, 1}}, Pose{}), 2);
    // Hard case 1: tiny triangles.
    for (const double s : {1.7e-4, 1e-4, 1e-5}) {
        const double h = s / 10;
        const Triangle a{{0, 0, 0}, {s, 0, 0}, {0, s, 0}},
            b{{s / 4, s / 4, h}, {5 * s / 4, s / 4, h + s}, {s / 4, 5 * s / 4, h + s}};
        expect_distance(signed_distance(a, Pose{}, b, Pose{}), h, 1e-15);
    }
}

TEST(KnownAnswers, WhatIsNoShapeOrNoPoseIsNotANumber) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Box unit{{1, 1, 1}};
    EXPECT_TRUE(std::isnan(signed_distance(unit, at(nan, 0, 0), unit, Pose{}).distance));
    EXPECT_TRUE(std::isnan(signed_distance(Sphere{nan}, Pose{}, unit, at(3, 0, 0)).lo));
    EXPECT_TRUE(std::isnan(signed_distance(Hull(), Pose{}, unit, at(3, 0, 0)).hi));
    const std::array<Vec3<double>, 3> holed{{{0, 0, 1}, {nan, 0, 0}, {1, 0, 0}}};
    EXPECT_TRUE(std::isnan(signed_distance(Hull(holed), Pose{}, unit, at(3, 0, 0)).hi));
    const Triangle corner{{0, 0, 0}, {0, nan, 0}, {1, 0, 0}};
    EXPECT_TRUE(std::isnan(signed_distance(corner, Pose{}, unit, at(3, 0, 0)).hi));
    EXPECT_TRUE(std::isnan(signed_distance(Plane{{0, 0, 0}, 1}, Pose{}, unit, Pose{}).hi));
    EXPECT_EQ(collide(unit, at(nan, 0, 0), unit, Pose{}).answer, Answer::maybe);
    EXPECT_EQ(collide(Sphere{1}, Pose{}, Sphere{nan}, Pose{}).answer, Answer::maybe);
    Pose twice{};
    for (int i = 0; i < 3; ++i)
        twice.rotation[static_cast<std::size_t>(i)][i] = 2;
    EXPECT_TRUE(std::isnan(signed_distance(unit, twice, unit, at(9, 0, 0)).distance));
    // Out of range the bounds are wide, but hold.
    const SignedDistance far = signed_distance(unit, at(1e200, 0, 0), unit, Pose{});
    EXPECT_LE(far.lo, 1e200);
    EXPECT_GE(far.hi, 1e200);
}

/// A rotation that is none by 1e-6: the bounds are as much wider.
TEST(KnownAnswers, RoundedRotationsWidenTheBounds) {
    Pose rough{};
    rough.rotation[0].x = 1 + 1e-6;
    const Box unit{{1, 1, 1}};
    const SignedDistance d = signed_distance(unit, rough, unit, at(5, 0, 0));
    EXPECT_LE(d.lo, 3 - 1e-6);
    EXPECT_GE(d.hi, 3);
    EXPECT_LT(d.hi - d.lo, 1e-4);
}

TEST(KnownAnswers, ToleranceWidensNoMoreThanItSays) {
    RandomPoses random(1);
    for (int k = 0; k < 200; ++k) {
        const Pose a{random.rotation(), {}}, b{random.rotation(), random.unit_vector() * 5.0};
        const Cone cone{1, 1};
        const Cylinder cylinder{1, .5};
        const SignedDistance fine = signed_distance(cone, a, cylinder, b);
        for (const double part : {1e-1, 1e-3, 1e-6}) {
            const SignedDistance d = signed_distance(cone, a, cylinder, b, {.relative = part});
            EXPECT_LE(d.lo, fine.hi);
            EXPECT_GE(d.hi, fine.lo);
            EXPECT_LE(d.hi - d.lo, part * d.hi + 1e-12);
            const SignedDistance e =
                signed_distance(cone, a, cylinder, b, {.relative = 0, .absolute = part});
            EXPECT_LE(e.hi - e.lo, part + 1e-12);
        }
    }
}

} // namespace
} // namespace boxwood::convex
