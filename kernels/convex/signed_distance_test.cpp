#include "kernels/convex/signed_distance.h"

#include "kernels/convex/detail/relative_pose.h"
#include "kernels/oracle/exact_vector.h"
#include "kernels/oracle/oracle.h"
#include "kernels/testing/posed_shapes.h"
#include "kernels/triangle_distance/certified.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace boxwood::convex {
namespace {

constexpr std::array bounded{ShapeKind::sphere,   ShapeKind::box,     ShapeKind::capsule,
                             ShapeKind::cylinder, ShapeKind::cone,    ShapeKind::ellipsoid,
                             ShapeKind::hull,     ShapeKind::triangle};

Pose at(double x, double y, double z) { return {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {x, y, z}}; }

SignedDistance measure(const PosedShape& a, const PosedShape& b, const Tolerance& tolerance = {}) {
    return signed_distance(a.shape, a.pose, b.shape, b.pose, tolerance);
}
std::string names(const PosedShape& a, const PosedShape& b) {
    return std::string(to_string(a.shape.kind())) + " " + std::string(to_string(b.shape.kind()));
}

double size_of(const PosedShape& a, const PosedShape& b) {
    const auto reach = [](const PosedShape& s) {
        return s.shape.visit([]<class S>(const S& x) -> double {
            if constexpr (BoundedShape<S>)
                return detail::reach(detail::core(x)) + detail::radius_of(x);
            else
                return std::abs(x.offset);
        });
    };
    return length(a.pose.translation - b.pose.translation) + reach(a) + reach(b);
}

/// How many answers were how wide, and what broke.
struct Judge {
    RandomPoses random{99};
    int answers = 0, wide = 0, very_wide = 0;

    /// lo holds by the gap along the normal itself, in long double; hi by the greatest gap that a
    /// search of directions finds, and where they are apart by the points being that near.
    void bounds(const PosedShape& a, const PosedShape& b, const SignedDistance& d,
                double relative = 1e-9) {
        const double size = size_of(a, b), width = d.hi - d.lo;
        ASSERT_LE(d.lo, d.distance) << names(a, b);
        ASSERT_LE(d.distance, d.hi) << names(a, b);
        // A closed form is accurate where its normal, over a short distance, is less so.
        const bool closed =
            a.shape.kind() == ShapeKind::sphere || b.shape.kind() == ShapeKind::sphere;
        ASSERT_GE(gap(a, b, wide_of(d.normal)),
                  static_cast<Wide>(d.lo) - (closed ? 1e-12L : 0) * size)
            << names(a, b);
        ASSERT_LE(greatest_gap(random, a, b, wide_of(d.normal), 24, 2, 12), static_cast<Wide>(d.hi))
            << names(a, b);
        const Vec3<double> off = (d.point_b - d.point_a) - d.normal * d.distance;
        ASSERT_LE(length(off), 32 * std::sqrt(std::max(width, 0.0) * size) + 1e-12 * size)
            << names(a, b);
        ASSERT_NEAR(length(d.normal), 1, 1e-14) << names(a, b);
        on_shape(a, d.point_a, size);
        on_shape(b, d.point_b, size);
        ++answers;
        wide += width > relative * std::abs(d.distance) + 1e-13 * size;
        very_wide += width > 1e-5 * std::abs(d.distance) + 1e-13 * size;
    }

  private:
    static WideVec wide_of(const Vec3<double>& v) { return convex::wide(v); }
    /// A point is in a convex shape if no direction tells the two apart.
    void on_shape(const PosedShape& s, const Vec3<double>& p, double size) {
        for (int i = 0; i < 16; ++i) {
            const WideVec d = normalized(convex::wide(random.unit_vector()));
            ASSERT_LE(dot(convex::wide(p), d), farthest(s, d) + 1e-13L * size)
                << to_string(s.shape.kind());
        }
    }
};

TEST(SignedDistance, ADepthSurelyParts) {
    const auto depth = [](double distance, double lo, double hi) {
        SignedDistance d;
        d.distance = distance;
        d.lo = lo;
        d.hi = hi;
        return d.depth();
    };
    EXPECT_EQ(depth(-2, -3, -1), 3);
    EXPECT_EQ(depth(0, -1, 1), 1); // they may be in one another so far
    EXPECT_EQ(depth(2, 1, 3), -2);
}

TEST(SignedDistance, BoundsHoldForAllPairsOfKinds) {
    RandomShapes shapes(1);
    Judge judge;
    for (const ShapeKind i : bounded)
        for (const ShapeKind j : bounded)
            for (int k = 0; k < 1600; ++k) {
                const PosedShape a = shapes.posed(i, 1.2), b = shapes.posed(j, 1.2);
                judge.bounds(a, b, measure(a, b));
                if (HasFatalFailure())
                    return;
            }
    EXPECT_GT(judge.answers, 100'000);
    EXPECT_LE(judge.wide, judge.answers / 100); // round shapes with many directions nearly alike
    EXPECT_LE(judge.very_wide, judge.answers / 2000);
}

TEST(SignedDistance, BoundsHoldForSizesFarApart) {
    RandomShapes shapes(2);
    Judge judge;
    for (const ShapeKind i : bounded)
        for (const ShapeKind j : bounded)
            for (int k = 0; k < 120; ++k) {
                // 1e-6 to 1e6 within one shape and between the two
                const double low = k % 3 == 0 ? -20 : 0, high = k % 3 == 1 ? 20 : 0;
                const PosedShape a = shapes.posed(i, std::exp2(high), low, high),
                                 b = shapes.posed(j, 1, -20, k % 2 ? 0 : -19);
                judge.bounds(a, b, measure(a, b), 1e-6);
                if (HasFatalFailure())
                    return;
            }
    EXPECT_LE(judge.very_wide, judge.answers / 100);
}

/// The point of the shape that is farthest along n.
Vec3<double> farthest_point(const PosedShape& s, const Vec3<double>& n) {
    const Vec3<double> local = detail::transposed_times(s.pose.rotation, n);
    return s.pose(s.shape.visit([&]<class S>(const S& x) -> Vec3<double> {
        if constexpr (BoundedShape<S>)
            return support(x, local);
        else
            return {};
    }));
}

/// Set on each other at the points that are farthest towards the other: rounding alone decides.
TEST(SignedDistance, OfEllipsoidsDeepInOneAnotherIsNarrow) {
    RandomPoses random(7);
    for (int k = 0; k < 300; ++k) {
        const auto ellipsoid = [&] {
            return Ellipsoid{{random.real(.25, .65), random.real(.25, .65), random.real(.25, .65)}};
        };
        const PosedShape a{ellipsoid(), Pose{random.rotation(), random.vector(.1)}},
            b{ellipsoid(), Pose{random.rotation(), random.vector(.1)}};
        const SignedDistance d = measure(a, b);
        ASSERT_LT(d.hi, 0);
        EXPECT_LE(d.hi - d.lo, 0x1p-15 * -d.hi) << k;
    }
}

TEST(SignedDistance, OfShapesThatTouchIsNothing) {
    RandomShapes shapes(3);
    for (const ShapeKind i : bounded)
        for (const ShapeKind j : bounded)
            for (int k = 0; k < 100; ++k) {
                const PosedShape a = shapes.posed(i, 1);
                PosedShape b = shapes.posed(j, 1);
                Vec3<double> n = shapes.random.unit_vector();
                if (k % 2) { // with a's and b's axes parallel
                    n = {a.pose.rotation[0].z, a.pose.rotation[1].z, a.pose.rotation[2].z};
                    b.pose.rotation = a.pose.rotation;
                }
                b.pose.translation =
                    b.pose.translation + (farthest_point(a, n) - farthest_point(b, -n));
                const double size = size_of(a, b);
                const SignedDistance d = measure(a, b);
                EXPECT_LE(d.lo, 0) << names(a, b);
                EXPECT_GE(d.hi, -1e-15 * size) << names(a, b); // b's place is rounded
                EXPECT_LE(d.hi - d.lo, 1e-7 * size) << names(a, b);
                EXPECT_NEAR(d.distance, 0, 1e-7 * size) << names(a, b);
            }
}

TEST(SignedDistance, DoesNotDependOnOrderPlaceOrScale) {
    RandomShapes shapes(4);
    for (const ShapeKind i : bounded)
        for (const ShapeKind j : bounded)
            for (int k = 0; k < 40; ++k) {
                const PosedShape a = shapes.posed(i, 1.2), b = shapes.posed(j, 1.2);
                const double size = size_of(a, b);
                const SignedDistance d = measure(a, b), swapped = measure(b, a);
                EXPECT_LE(swapped.lo, d.hi) << names(a, b);
                EXPECT_GE(swapped.hi, d.lo) << names(a, b);

                const Pose all{shapes.random.rotation(), shapes.random.vector(3)};
                const auto moved = [&](PosedShape s) {
                    s.pose = {product(all.rotation, s.pose.rotation), all(s.pose.translation)};
                    return s;
                };
                const SignedDistance m = measure(moved(a), moved(b));
                EXPECT_LE(m.lo, d.hi + 1e-14 * size) << names(a, b); // poses are rounded
                EXPECT_GE(m.hi, d.lo - 1e-14 * size) << names(a, b);
            }
    // Powers of two change nothing but the scale.
    for (int k = 0; k < 200; ++k) {
        const PosedShape a = shapes.posed(ShapeKind::box, 1), b = shapes.posed(ShapeKind::cone, 1);
        const double f = std::exp2(shapes.random.whole(-60, 60));
        const Box box{a.shape.get_if<Box>()->half * f};
        const Cone cone{b.shape.get_if<Cone>()->radius * f,
                        b.shape.get_if<Cone>()->half_length * f};
        const SignedDistance d = measure(a, b),
                             s = signed_distance(box, {a.pose.rotation, a.pose.translation * f},
                                                 cone, {b.pose.rotation, b.pose.translation * f});
        EXPECT_EQ(s.distance, d.distance * f);
        EXPECT_EQ(s.lo, d.lo * f);
        EXPECT_EQ(s.hi, d.hi * f);
    }
}

TEST(SignedDistance, OfHalfSpacesAndPlanesIsAlongTheirNormals) {
    RandomShapes shapes(5);
    for (const ShapeKind i : bounded)
        for (const ShapeKind j : {ShapeKind::half_space, ShapeKind::plane})
            for (int k = 0; k < 300; ++k) {
                const PosedShape a = shapes.posed(i, 1), b = shapes.posed(j, 1);
                const SignedDistance d = measure(a, b), swapped = measure(b, a);
                EXPECT_EQ(d.distance, swapped.distance);
                EXPECT_EQ(d.point_a, swapped.point_b);
                const auto [normal, offset] = j == ShapeKind::plane
                                                  ? std::pair{b.shape.get_if<Plane>()->normal,
                                                              b.shape.get_if<Plane>()->offset}
                                                  : std::pair{b.shape.get_if<HalfSpace>()->normal,
                                                              b.shape.get_if<HalfSpace>()->offset};
                Vec3<double> n;
                for (int r = 0; r < 3; ++r)
                    n[r] = dot(b.pose.rotation[static_cast<std::size_t>(r)], normal);
                const Wide level = offset + dot(wide(n), wide(b.pose.translation));
                const WideVec up = wide(n), down = wide(-n);
                Wide truth = -farthest(a, down) - level;
                if (j == ShapeKind::plane)
                    truth = std::max(truth, level - farthest(a, up));
                EXPECT_LE(d.lo, truth);
                EXPECT_GE(d.hi, truth);
                EXPECT_LE(d.hi - d.lo, 3e-13);
                EXPECT_NEAR(length((d.point_b - d.point_a) - d.normal * d.distance), 0, 3e-13);
            }
}

TEST(SignedDistance, OfTwoHalfSpacesOrPlanes) {
    const HalfSpace up{{0, 0, 2}, 2}, down{{0, 0, -1}, -4}, tilted{{0, 1, 1}, 0}; // z <= 1, z >= 4
    const Plane plane{{0, 0, 1}, 2};
    const auto far = [](const auto& a, const auto& b) {
        return signed_distance(a, Pose{}, b, Pose{}).distance;
    };
    constexpr double none = -std::numeric_limits<double>::infinity();
    EXPECT_EQ(far(up, down), 3);
    EXPECT_EQ(far(down, up), 3);
    EXPECT_EQ(far(up, up), none);
    EXPECT_EQ(far(up, tilted), none);
    EXPECT_EQ(far(up, plane), 1);
    EXPECT_EQ(far(plane, up), 1);
    EXPECT_EQ(far(down, plane), 2);
    EXPECT_EQ(far(plane, plane), 0);
    EXPECT_EQ(far(plane, Plane{{0, 0, -1}, 3}), 5);
    EXPECT_EQ(far(HalfSpace{{0, 0, 1}, 3}, plane), -1);
}

/// Against the certified kernel for triangles, which is judged by rationals.
TEST(SignedDistance, OfTrianglesAgreesWithTheirOwnKernel) {
    RandomPoses random(6);
    for (int k = 0; k < 20'000; ++k) {
        const bool whole = k % 2;
        const auto point = [&] {
            return whole ? Vec3<double>{double(random.whole(-2, 2)), double(random.whole(-2, 2)),
                                        double(random.whole(-2, 2))}
                         : random.vector(1);
        };
        const Triangle a{point(), point(), point()}, b{point(), point(), point()};
        const SignedDistance d = signed_distance(a, Pose{}, b, Pose{});
        const Distance truth = CertifiedDistance::distance(a, b);
        if (truth.lo > 0) {
            EXPECT_LE(d.lo, truth.hi);
            EXPECT_GE(d.hi, truth.lo);
            EXPECT_LE(d.hi - d.lo, 1e-9 * d.hi + 1e-13);
        } else {
            EXPECT_LE(d.lo, 0);
        }
    }
}

TEST(SignedDistance, OfSpheresHoldsInRationals) {
    RandomPoses random(7);
    for (int k = 0; k < 20'000; ++k) {
        const Sphere a{std::exp2(random.real(-20, 20))}, b{std::exp2(random.real(-20, 20))};
        Pose pose_a = at(0, 0, 0), pose_b = at(0, 0, 0);
        pose_a.translation = random.vector(1);
        const double apart = (a.radius + b.radius) * (k % 2 ? 1 : std::exp2(random.real(-2, 2)));
        pose_b.translation = pose_a.translation + random.unit_vector() * apart;
        const SignedDistance d = signed_distance(a, pose_a, b, pose_b);
        const auto square = [](const mpq_class& x) { return mpq_class(x * x); };
        const mpq_class reach = oracle::exact(a.radius) + oracle::exact(b.radius);
        mpq_class squared = 0;
        for (int i = 0; i < 3; ++i)
            squared +=
                square(oracle::exact(pose_b.translation[i]) - oracle::exact(pose_a.translation[i]));
        const mpq_class lo = oracle::exact(d.lo) + reach, hi = oracle::exact(d.hi) + reach;
        EXPECT_TRUE(lo <= 0 || square(lo) <= squared);
        EXPECT_TRUE(hi >= 0 && square(hi) >= squared);
        const Answer said = collide(a, pose_a, b, pose_b).answer;
        EXPECT_NE(said, squared <= square(reach) ? Answer::no : Answer::yes);
    }
}

TEST(SignedDistance, OfBoxesAgreesWithRationalsOnWhetherTheyTouch) {
    RandomShapes shapes(8);
    for (int k = 0; k < 20'000; ++k) {
        PosedShape a = shapes.posed(ShapeKind::box, 1), b = shapes.posed(ShapeKind::box, 1);
        if (k % 2) { // near contact
            const Vec3<double> n = measure(a, b).normal;
            b.pose.translation =
                b.pose.translation - n * (measure(a, b).distance * (1 + 1e-15 * (k % 9 - 4)));
        }
        const auto centre_and_axes = [](const Pose& p) {
            std::array<Vec3<double>, 4> out{p.translation, {}, {}, {}};
            for (std::size_t i = 0; i < 3; ++i)
                out[i + 1] = {p.rotation[0][static_cast<int>(i)],
                              p.rotation[1][static_cast<int>(i)],
                              p.rotation[2][static_cast<int>(i)]};
            return out;
        };
        const bool touch =
            oracle::boxes_touch(centre_and_axes(a.pose), a.shape.get_if<Box>()->half,
                                centre_and_axes(b.pose), b.shape.get_if<Box>()->half);
        const SignedDistance d = measure(a, b);
        EXPECT_TRUE(touch ? d.lo <= 0 : d.hi >= 0);
        EXPECT_NE(collide(a.shape, a.pose, b.shape, b.pose).answer,
                  touch ? Answer::no : Answer::yes);
    }
}

TEST(Within, SaysWhatTheBoundsSay) {
    RandomShapes shapes(9);
    int decided = 0, all = 0;
    for (const ShapeKind i : bounded)
        for (const ShapeKind j : bounded)
            for (int k = 0; k < 200; ++k) {
                const double apart = k < 50 ? 0.05 : 1.2; // the first lie deep in one another
                const PosedShape a = shapes.posed(i, apart), b = shapes.posed(j, apart);
                const SignedDistance d = measure(a, b);
                for (const double t :
                     {0.0, 0.5, d.distance * 1.01, d.distance * 0.99, d.lo, d.hi, -0.1}) {
                    const Answer said = within(a.shape, a.pose, b.shape, b.pose, t).answer;
                    EXPECT_FALSE(said == Answer::yes && d.lo > t) << names(a, b) << " " << t;
                    EXPECT_FALSE(said == Answer::no && d.hi <= t) << names(a, b) << " " << t;
                    if (std::abs(t - d.distance) > 0.005 * std::abs(d.distance)) {
                        ++all;
                        decided += said != Answer::maybe;
                    }
                }
            }
    EXPECT_GE(decided, all - all / 2000);
}

/// Around one centre several directions are as good; the points belong to the one that is said.
TEST(SignedDistance, PointsBelongToTheNormalAroundOneCentre) {
    std::mt19937 random(7);
    const auto quarters = [&] { return .25 * std::uniform_int_distribution<int>(1, 6)(random); };
    const auto shape = [&](int kind) -> Shape {
        const double x = quarters(), y = quarters(), z = quarters();
        return kind == 0   ? Shape(Box{{x, y, z}})
               : kind == 1 ? Shape(Capsule{x, y})
                           : Shape(Cylinder{x, y});
    };
    int n_narrow = 0, n_bad = 0;
    for (int i = 0; i < 4000; ++i) {
        const SignedDistance d =
            signed_distance(shape(i % 3), at(0, 0, 0), shape(i / 3 % 3), at(0, 0, 0));
        if (!(d.hi < 0 && d.hi - d.lo < 1e-7))
            continue;
        ++n_narrow;
        n_bad += length(d.point_b - d.point_a - d.distance * d.normal) >
                 1e-4 + 10 * std::sqrt(4 * (d.hi - d.lo));
    }
    EXPECT_GT(n_narrow, 2000);
    EXPECT_EQ(n_bad, 0);
}

} // namespace
} // namespace boxwood::convex
