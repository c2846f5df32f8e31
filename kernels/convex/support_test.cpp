#include "kernels/convex/support.h"

#include "kernels/testing/posed_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace boxwood::convex {
namespace {

constexpr std::array bounded{ShapeKind::sphere,   ShapeKind::box,     ShapeKind::capsule,
                             ShapeKind::cylinder, ShapeKind::cone,    ShapeKind::ellipsoid,
                             ShapeKind::hull,     ShapeKind::triangle};

TEST(Support, IsTheFarthestPointAndOnTheShape) {
    RandomShapes shapes(1);
    for (const ShapeKind kind : bounded)
        for (int k = 0; k < 2000; ++k) {
            const PosedShape s{shapes.shape(kind, -10, 10), {}};
            const Vec3<double> d =
                shapes.random.unit_vector() * std::exp2(shapes.random.real(-100, 100));
            const Vec3<double> p = s.shape.visit([&]<class S>(const S& x) -> Vec3<double> {
                if constexpr (BoundedShape<S>)
                    return support(x, d);
                else
                    return {};
            });
            const Wide truth = farthest(s, wide(d)), size = length(d) * Wide(4096);
            EXPECT_NEAR(static_cast<double>((dot(wide(p), wide(d)) - truth) / size), 0, 1e-15)
                << to_string(kind);
            for (int i = 0; i < 8; ++i) {
                const WideVec e = normalized(wide(shapes.random.unit_vector()));
                EXPECT_LE(dot(wide(p), e), farthest(s, e) + 1e-12L) << to_string(kind);
            }
        }
}

TEST(Support, OfAnEllipsoidsCoreAndTheBallIsThatOfTheEllipsoid) {
    RandomShapes shapes(2);
    RandomPoses& random = shapes.random;
    for (int k = 0; k < 4000; ++k) {
        const Ellipsoid s{{random.real(.1, 2), random.real(.1, 2), random.real(.1, 2)}};
        const detail::EllipsoidCore core = detail::core(s);
        const Vec3<double> n = random.unit_vector();
        const Vec3<double> p = detail::support(core, n);
        EXPECT_LE(length(p + n * core.ball - support(s, n)), 1e-15 * detail::reach(core) + 1e-15);
        // Convex: no other of its points is farther.
        const Vec3<double> other = detail::support(core, random.unit_vector());
        EXPECT_LE(dot(other, n), dot(p, n) + 1e-14);
        EXPECT_LE(length(p), detail::reach(core));
    }
    EXPECT_EQ(detail::radius_of(Ellipsoid{{1, 0, 2}}), 0);
    EXPECT_NEAR(detail::radius_of(Ellipsoid{{3, 3, 3}}), 3, 1e-14);
}

TEST(InnerRadius, IsOfABallInTheShape) {
    RandomShapes shapes(3);
    for (const ShapeKind kind : bounded)
        for (int k = 0; k < 500; ++k) {
            const Shape s = shapes.shape(kind, -10, 10);
            const double inner = s.visit([]<class S>(const S& x) -> double {
                if constexpr (requires { detail::inner_radius(detail::core(x)); })
                    return detail::inner_radius(detail::core(x)) + detail::radius_of(x);
                else // none is promised
                    return -std::numeric_limits<double>::infinity();
            });
            Wide least = std::numeric_limits<Wide>::infinity();
            for (int i = 0; i < 200; ++i) {
                const Wide extent =
                    farthest(PosedShape{s, {}}, normalized(wide(shapes.random.unit_vector())));
                EXPECT_GE(extent, inner * (1 - 1e-15L)) << to_string(kind);
                least = std::min(least, extent);
            }
            if (kind == ShapeKind::sphere) {
                EXPECT_NEAR(inner, static_cast<double>(least), 1e-14 * inner);
            }
        }
    // As large as it can be.
    EXPECT_NEAR(detail::inner_radius(Cone{1, 2}), 2 / std::sqrt(17.0), 1e-14);
    EXPECT_EQ(detail::inner_radius(Cone{1, 0}), 0);
    EXPECT_EQ(detail::inner_radius(Box{{3, 1, 2}}), 1);
    EXPECT_EQ(detail::inner_radius(Cylinder{2, 5}), 2);
}

TEST(Support, OfDirectionsAlongAxes) {
    const Cylinder cylinder{1, 2};
    const Cone cone{1, 2};
    EXPECT_EQ(support(cylinder, {0, 0, 1}).z, 2);
    EXPECT_EQ(support(cylinder, {0, 0, -1}).z, -2);
    EXPECT_EQ(support(cylinder, {3, 0, 0}).x, 1);
    EXPECT_EQ(support(cone, {0, 0, 1}), (Vec3<double>{0, 0, 2}));
    EXPECT_EQ(support(cone, {0, 0, -1}).z, -2);
    EXPECT_EQ(support(cone, {5, 0, 0}), (Vec3<double>{1, 0, -2}));
    EXPECT_EQ(support(Ellipsoid{{1, 2, 3}}, {0, -4, 0}), (Vec3<double>{0, -2, 0}));
    EXPECT_EQ(support(Sphere{2}, {0, 0, 0}), (Vec3<double>{}));
    EXPECT_EQ(support(Box{{1, 2, 3}}, {1, -1, 1}), (Vec3<double>{1, -2, 3}));
}

/// Of several points as far the first, however many there are.
TEST(Support, OfAHullIsTheFirstOfTheFarthest) {
    std::vector<Vec3<double>> points;
    EXPECT_EQ(support(Hull(points), {1, 0, 0}), (Vec3<double>{}));
    for (std::size_t n = 1; n <= 30; ++n) {
        points.push_back({double(n * 7 % 3), double(n * 5 % 4), double(n % 2)});
        const Hull hull(points);
        for (double x = -1; x <= 1; ++x)
            for (double y = -1; y <= 1; ++y)
                for (double z = -1; z <= 1; ++z) {
                    const Vec3<double> d{x, y, z};
                    const auto first = std::ranges::max_element(
                        points, {}, [&](Vec3<double> p) { return dot(p, d); });
                    ASSERT_EQ(support(hull, d), *first) << n;
                }
    }
}

TEST(ExtentAlong, HoldsTheShapeTightly) {
    RandomShapes shapes(2);
    for (const ShapeKind kind : bounded)
        for (int k = 0; k < 2000; ++k) {
            const PosedShape s = shapes.posed(kind, 100, -10, 10);
            const Vec3<double> d = shapes.random.unit_vector();
            const Extent e = extent_along(s.shape, s.pose, d);
            const Wide most = farthest(s, wide(d)), least = -farthest(s, wide(-d));
            EXPECT_LE(e.least, least) << to_string(kind);
            EXPECT_GE(e.greatest, most) << to_string(kind);
            EXPECT_LE(e.greatest - most, 1e-10);
            EXPECT_LE(least - e.least, 1e-10);
            const Aabb<double> box = bounds(s.shape, s.pose);
            for (int i = 0; i < 3; ++i) {
                WideVec axis{}, back{};
                axis[static_cast<std::size_t>(i)] = 1, back[static_cast<std::size_t>(i)] = -1;
                EXPECT_GE(box.max[i], farthest(s, axis)) << to_string(kind);
                EXPECT_LE(box.min[i], -farthest(s, back)) << to_string(kind);
                EXPECT_LE(box.max[i] - farthest(s, axis), 1e-10);
            }
        }
}

TEST(ExtentAlong, OfWhatHasNoBoundsIsInfinite) {
    EXPECT_EQ(bounds(Plane{}, {}).max.x, std::numeric_limits<double>::infinity());
    EXPECT_EQ(extent_along(HalfSpace{}, {}, {0, 0, 1}).least,
              -std::numeric_limits<double>::infinity());
}

TEST(Shape, KeepsWhatItIs) {
    const Shape s = Cone{1, 2};
    EXPECT_EQ(s.kind(), ShapeKind::cone);
    EXPECT_EQ(to_string(s.kind()), "cone");
    EXPECT_EQ(s.get_if<Box>(), nullptr);
    ASSERT_NE(s.get_if<Cone>(), nullptr);
    EXPECT_EQ(s.get_if<Cone>()->half_length, 2);
    EXPECT_EQ(Shape().kind(), ShapeKind::sphere);
}

} // namespace
} // namespace boxwood::convex
