#include "kernels/convex/first_contact.h"

#include "kernels/testing/posed_shapes.h"

#include <gtest/gtest.h>

#include <limits>

namespace boxwood::convex {
namespace {

constexpr std::array bounded{ShapeKind::sphere,   ShapeKind::box,     ShapeKind::capsule,
                             ShapeKind::cylinder, ShapeKind::cone,    ShapeKind::ellipsoid,
                             ShapeKind::hull,     ShapeKind::triangle};

Pose at(double x, double y, double z) { return {Pose{}.rotation, {x, y, z}}; }
Motion still(const Pose& pose) { return {pose, {}, {}, {}}; }

TEST(Motion, EndsWhereItShould) {
    RandomPoses random(1);
    for (int k = 0; k < 2000; ++k) {
        const Pose from{random.rotation(), random.vector(1)},
            to{product(random.rotation(random.unit_vector(), std::exp2(random.real(-30, 1.6))),
                       from.rotation),
               random.vector(1)};
        for (const Motion& m : {linear_motion(from, to), screw_motion(from, to)}) {
            const Pose start = pose_at(m, 0), end = pose_at(m, 1);
            const double far = length(m.centre); // of the axis of a small turn
            EXPECT_LT(length(start.translation - from.translation), 1e-14 * (1 + far));
            EXPECT_LT(length(end.translation - to.translation), 1e-13 * (1 + far));
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_LT(length(end.rotation[i] - to.rotation[i]), 1e-7);
        }
    }
}

TEST(Motion, OfAScrewShiftsAlongItsAxis) {
    Pose to = at(0, 2, 3); // a quarter turn about z through (-1, 1), and up by 3
    to.rotation = RandomPoses::rotation({0, 0, 1}, std::acos(-1.0) / 2);
    const Motion m = screw_motion(at(0, 0, 0), to);
    EXPECT_NEAR(length(m.centre - Vec3<double>{-1, 1, 0}), 0, 1e-14);
    EXPECT_NEAR(length(m.velocity - Vec3<double>{0, 0, 3}), 0, 1e-14);
    const Pose middle = pose_at(m, .5);
    EXPECT_NEAR(middle.translation.z, 1.5, 1e-14);
    EXPECT_NEAR(std::hypot(middle.translation.x + 1, middle.translation.y - 1), std::sqrt(2),
                1e-14);
}

TEST(FirstContact, DoesNotTunnel) { // hard cases 7 and 8
    const Box plate{{.05, .5, .5}};
    const Sphere ball{.05};
    for (const double l : {1.0, 2.0, 10.0, 1000.0}) {
        const double truth = (l - .1) / (2 * l);
        for (const Motion& m :
             {linear_motion(at(-l, 0, 0), at(l, 0, 0)), screw_motion(at(-l, 0, 0), at(l, 0, 0))}) {
            const FirstContact f = first_contact(ball, m, plate, still({}));
            EXPECT_EQ(f.answer, Answer::yes);
            EXPECT_LE(f.t_free, truth);
            EXPECT_GE(f.t_hit, truth);
            EXPECT_LE(f.t_hit - f.t_free, 1e-10);
            const FirstContact g = first_contact(plate, still({}), ball, m);
            EXPECT_LE(g.t_free, truth);
            EXPECT_GE(g.t_hit, truth);
        }
    }
    // Through a plate without thickness, spinning as fast as may be.
    Motion m = linear_motion(at(-9, 0, 0), at(9, 0, 0));
    m.spin = {0, 40, 0};
    const FirstContact f = first_contact(Capsule{1e-4, .3}, m, Box{{0, 1, 1}}, still({}));
    EXPECT_EQ(f.answer, Answer::yes);
    EXPECT_LE(f.t_free, .5);
    EXPECT_GE(f.t_hit, .48);
    EXPECT_LE(f.t_hit - f.t_free, 1e-6);
}

TEST(FirstContact, OfSpheresIsTheRootOfAQuadratic) {
    RandomPoses random(2);
    int hits = 0;
    for (int k = 0; k < 3000; ++k) {
        const Sphere a{random.real(.01, 1)}, b{random.real(.01, 1)};
        const Vec3<double> p = random.vector(3), q = random.vector(3), v = random.vector(6),
                           w = random.vector(6);
        const Vec3<double> r = q - p, s = w - v;
        const long double reach = static_cast<long double>(a.radius) + b.radius;
        const long double ss = dot(wide(s), wide(s)), rs = dot(wide(r), wide(s)),
                          c = dot(wide(r), wide(r)) - reach * reach;
        const FirstContact f =
            first_contact(a, {at(p.x, p.y, p.z), v, {}, {}}, b, {at(q.x, q.y, q.z), w, {}, {}});
        if (c <= 0) {
            EXPECT_EQ(f.t_free, 0);
            continue;
        }
        const long double under = rs * rs - ss * c;
        const long double t = under < 0 ? 2 : (-rs - std::sqrt(under)) / ss;
        if (t >= 0 && t <= 1) {
            ++hits;
            EXPECT_NE(f.answer, Answer::no);
            EXPECT_LE(f.t_free, t + 1e-15L);
            EXPECT_GE(f.t_hit, t - 1e-15L);
        } else {
            EXPECT_NE(f.answer, Answer::yes);
        }
    }
    EXPECT_GT(hits, 50);
}

/// Between 0 and t_free no sampled pose overlaps; at t_hit one does.
TEST(FirstContact, MissesNothingBetweenItsSteps) {
    RandomShapes shapes(3);
    int hits = 0, open = 0, all = 0;
    for (const ShapeKind i : bounded)
        for (const ShapeKind j : bounded)
            for (int k = 0; k < 40; ++k) {
                const PosedShape a = shapes.posed(i, 2), b = shapes.posed(j, 2);
                const auto motion = [&](const PosedShape& s) -> Motion {
                    const Pose to{shapes.random.rotation(), shapes.random.vector(2)};
                    if (k % 3 == 0)
                        return {s.pose, shapes.random.vector(4), {}, {}};
                    if (k % 3 == 1)
                        return screw_motion(s.pose, to);
                    return {s.pose, shapes.random.vector(4), shapes.random.vector(9),
                            s.pose.translation};
                };
                const Motion of_a = motion(a), of_b = motion(b);
                const FirstContact f = first_contact(a.shape, of_a, b.shape, of_b);
                ++all;
                open += f.answer == Answer::maybe;
                const auto distance = [&](double t) {
                    return signed_distance(a.shape, pose_at(of_a, t), b.shape, pose_at(of_b, t));
                };
                for (int s = 0; s < 60 && f.t_free > 0; ++s) {
                    const double t = f.t_free * s / 60;
                    ASSERT_GE(distance(t).hi, 0) << to_string(i) << " " << to_string(j) << " " << t;
                }
                if (f.answer != Answer::yes)
                    continue;
                ++hits;
                EXPECT_EQ(collide(a.shape, pose_at(of_a, f.t_hit), b.shape, pose_at(of_b, f.t_hit))
                              .answer,
                          Answer::yes);
                EXPECT_LE(f.t_free, f.t_hit);
                EXPECT_LE(f.t_hit - f.t_free, 1e-4);
            }
    EXPECT_GT(hits, all / 6);
    EXPECT_LE(open, all / 100);
}

TEST(FirstContact, OfHalfSpacesThatDoNotSpin) {
    const HalfSpace floor{{0, 0, 1}, 0};
    const FirstContact f =
        first_contact(Box{{1, 1, 1}}, linear_motion(at(0, 0, 5), at(0, 0, -3)), floor, still({}));
    EXPECT_EQ(f.answer, Answer::yes);
    EXPECT_LE(f.t_free, .5);
    EXPECT_GE(f.t_hit, .5);
    EXPECT_LE(f.t_hit - f.t_free, 1e-10);
    const Motion spinning{{}, {}, {1, 0, 0}, {}};
    EXPECT_EQ(first_contact(Sphere{1}, still(at(0, 0, 5)), floor, spinning).answer, Answer::maybe);
}

TEST(FirstContact, AtTheStartAndNever) {
    const Box unit{{1, 1, 1}};
    const FirstContact in = first_contact(unit, still({}), unit, still(at(1, 0, 0)));
    EXPECT_EQ(in.answer, Answer::yes);
    EXPECT_EQ(in.t_hit, 0);
    EXPECT_EQ(first_contact(unit, still({}), unit, still(at(3, 0, 0))).answer, Answer::no);
    const Motion away = linear_motion(at(3, 0, 0), at(9, 0, 0));
    EXPECT_EQ(first_contact(unit, still({}), unit, away).answer, Answer::no);
    // They slide along one another and touch: neither free nor an overlap is proven.
    const Motion along = linear_motion(at(-4, 2, 0), at(4, 2, 0));
    const FirstContact grazing = first_contact(unit, still({}), unit, along);
    EXPECT_EQ(grazing.answer, Answer::maybe);
    EXPECT_LE(grazing.t_free, .25);
}

} // namespace
} // namespace boxwood::convex
