/// How deep a solid and a convex shape are in each other, against points all over both surfaces:
/// closed forms, which know nothing of kernels, trees and bounds.

#include "trees/testing/test_bodies.h"
#include "trees/world/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace boxwood {
namespace {

constexpr double spacing = .02; ///< no point of a surface is farther from one of ours
using Points = std::vector<Vec3<double>>;

/// A grid over a rectangle about `at`, whose half sides are u and v.
void add_rectangle(Points& points, const Vec3<double>& at, const Vec3<double>& u,
                   const Vec3<double>& v) {
    const auto steps = [](double half) {
        return std::max(1, static_cast<int>(std::ceil(2 * half / spacing)));
    };
    const int n = steps(length(u)), m = steps(length(v));
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= m; ++j)
            points.push_back(at + (2. * i / n - 1) * u + (2. * j / m - 1) * v);
}

Points on_box(const Vec3<double>& half) {
    Points points;
    const Vec3<double> x{half.x, 0, 0}, y{0, half.y, 0}, z{0, 0, half.z};
    for (const double side : {-1., 1.}) {
        add_rectangle(points, side * x, y, z);
        add_rectangle(points, side * y, x, z);
        add_rectangle(points, side * z, x, y);
    }
    return points;
}
double depth_in_box(const Vec3<double>& half, const Vec3<double>& p) {
    return std::min({half.x - std::abs(p.x), half.y - std::abs(p.y), half.z - std::abs(p.z)});
}

Points on_ball(double radius) {
    Points points;
    const int n = static_cast<int>(std::ceil(radius * std::numbers::pi / spacing)) + 1;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j < 2 * n; ++j) {
            const double t = std::numbers::pi * i / n, f = std::numbers::pi * j / n;
            points.push_back(radius * Vec3<double>{std::sin(t) * std::cos(f),
                                                   std::sin(t) * std::sin(f), std::cos(t)});
        }
    return points;
}

Points on_cylinder(double radius, double half) {
    Points points;
    const int around = static_cast<int>(std::ceil(2 * std::numbers::pi * radius / spacing)) + 1,
              along = static_cast<int>(std::ceil(2 * half / spacing)) + 1,
              inwards = static_cast<int>(std::ceil(radius / spacing)) + 1;
    for (int i = 0; i < around; ++i) {
        const double f = 2 * std::numbers::pi * i / around;
        const Vec3<double> out{std::cos(f), std::sin(f), 0};
        for (int j = 0; j <= along; ++j)
            points.push_back(radius * out + Vec3<double>{0, 0, (2. * j / along - 1) * half});
        for (int j = 0; j <= inwards; ++j)
            for (const double end : {-half, half})
                points.push_back((radius * j / inwards) * out + Vec3<double>{0, 0, end});
    }
    return points;
}

Points on_flat(const Vec3<double>& normal, double offset) {
    const Vec3<double> n = (1 / length(normal)) * normal;
    const Vec3<double> other = std::abs(n.x) < .5 ? Vec3<double>{1, 0, 0} : Vec3<double>{0, 1, 0};
    Vec3<double> u = cross(n, other);
    u = (3 / length(u)) * u;
    Points points;
    add_rectangle(points, (offset / length(normal)) * n, u, cross(n, u));
    return points;
}

struct Known {
    const char* name;
    convex::Shape shape;
    Points surface;
    std::function<double(const Vec3<double>&)> depth; ///< of a point of its frame
};
std::vector<Known> known_shapes() {
    const Vec3<double> half{.5, .8, .3}, normal{1, 2, -2};
    return {{"ball", convex::Sphere{.8}, on_ball(.8), [](auto p) { return .8 - length(p); }},
            {"box", convex::Box{half}, on_box(half), [=](auto p) { return depth_in_box(half, p); }},
            {"cylinder", convex::Cylinder{.4, .9}, on_cylinder(.4, .9),
             [](auto p) { return std::min(.4 - std::hypot(p.x, p.y), .9 - std::abs(p.z)); }},
            {"half-space", convex::HalfSpace{normal, -.6}, on_flat(normal, -.6),
             [=](auto p) { return (-.6 - dot(normal, p)) / length(normal); }},
            {"plane", convex::Plane{normal, .3}, on_flat(normal, .3), [](auto) { return 0.; }}};
}

TEST(Deepest, OfASolidAndAShapeIsWhereAnyPointIsDeepest) {
    const Solid cube(cube_mesh(1));
    const Points on_cube = on_box({1, 1, 1});
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-1.3, 1.3);
    std::size_t deep = 0, of_cube = 0, inside = 0;
    for (const Known& known : known_shapes())
        for (int i = 0; i < 12; ++i) {
            const double near = i % 3 == 0 ? .1 : 1; // one that lies inside
            const Pose pose = random_pose(
                random, near * Vec3<double>{place(random), place(random), place(random)});
            const Pose back = relative_pose(pose, Pose{});
            double into_shape = 0, into_cube = 0;
            for (const Vec3<double>& p : on_cube)
                into_shape = std::max(into_shape, known.depth(back(p)));
            bool reaches_out = false;
            for (const Vec3<double>& p : known.surface) {
                const double depth = depth_in_box({1, 1, 1}, pose(p));
                into_cube = std::max(into_cube, depth);
                reaches_out |= depth < 0;
            }
            const double seen = std::max(into_shape, into_cube);
            constexpr double tolerance = .02;
            const SolidDistance found = signed_distance(cube, known.shape, pose, tolerance);
            EXPECT_TRUE(found.lo <= found.distance && found.distance <= found.hi) << known.name;
            if (seen == 0) {
                EXPECT_GE(found.hi, -spacing) << known.name;
                continue;
            }
            ++deep;
            of_cube += into_shape > into_cube;
            inside += !reaches_out;
            EXPECT_LE(found.lo, -seen + 1e-9) << known.name;
            EXPECT_GE(found.hi, -seen - spacing) << known.name;
            EXPECT_LE(found.hi - found.lo, tolerance + 1e-5) << known.name;
            // The point lies in both, as deep as is said in one of them.
            const double depth =
                std::max(depth_in_box({1, 1, 1}, found.point_a), known.depth(back(found.point_a)));
            EXPECT_GE(depth, -found.distance - 1e-5) << known.name;
        }
    EXPECT_GT(deep, 30u);
    EXPECT_GT(of_cube, 5u);
    EXPECT_GT(inside, 2u);
}

TEST(Deepest, OfEveryKindIsAsOfItsOwnSides) {
    const BodyShape solid = BodyShape::solid(cube_mesh(.5));
    std::mt19937 random(6);
    std::uniform_real_distribution<double> place(-1, 1);
    std::size_t deep = 0, apart = 0;
    std::vector<BodyShape> shapes = shapes_of_all_kinds();
    shapes.emplace_back(convex::Sphere{0});
    for (const BodyShape& shape : shapes) {
        if (shape.shape_class() == ShapeClass::surface)
            continue;
        for (int i = 0; i < 4; ++i) {
            const PosedShape a{solid, random_pose(random, {0, 0, 0})},
                b{shape, random_pose(random, {place(random), place(random), place(random)})};
            const BodyDistance d = signed_distance(a, b), back = signed_distance(b, a);
            EXPECT_EQ(collide(a, b) == Answer::no, d.lo > 0);
            EXPECT_LE(d.lo, back.hi + 1e-9);
            EXPECT_LE(back.lo, d.hi + 1e-9);
            (d.lo > 0 ? apart : deep) += 1;
            if (d.lo > 0) {
                EXPECT_NEAR(d.distance, distance(a, b).distance, 1e-9);
            }
            const BodyDistance wide =
                signed_distance(PosedShape{solid, a.pose, .25}, PosedShape{shape, b.pose, .125});
            EXPECT_NEAR(wide.lo, d.lo - .375, 1e-6);
            EXPECT_NEAR(wide.hi, d.hi - .375, 1e-6);
        }
    }
    EXPECT_GT(deep, 10u);
    EXPECT_GT(apart, 5u);
}

/// Far from the origin floats are coarse: the bounds are wide, and the search ends.
TEST(Deepest, EndsWhereFloatsAreCoarse) {
    const Solid cube(cube_mesh(1, {4096, 4096, 4096}));
    const SolidDistance d =
        signed_distance(cube, convex::Sphere{1}, {Pose{}.rotation, {4096, 4096, 4097}}, 1e-12);
    EXPECT_LE(d.lo, -1);
    EXPECT_GE(d.hi, -1 - 1e-9);
    EXPECT_LE(d.hi - d.lo, .01);
}

} // namespace
} // namespace boxwood
