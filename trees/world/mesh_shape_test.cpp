#include "trees/world/mesh_shape.h"

#include "kernels/triangle_distance/certified.h"
#include "trees/testing/shapes_at_random.h"
#include "trees/testing/test_meshes.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

using convex::Shape;
using convex::ShapeKind;

/// Of every triangle, in the mesh's frame as it stands.
std::vector<convex::SignedDistance> distances_by_force(const TriangleMesh& mesh, const Shape& shape,
                                                       const Pose& pose) {
    std::vector<convex::SignedDistance> all;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        all.push_back(convex::signed_distance(triangle_at(mesh, i), Pose{}, shape, pose));
    return all;
}

/// What the kernels' bounds may be off by at most, of sizes about 4.
constexpr double kernel_width = 1e-12;
/// The same of distances and of depths of round shapes, whose nearest points are many nearly alike.
constexpr double round_width = 1e-7, depth_width = 1e-4;

bool is_on_triangle(const Vec3<double>& p, const Triangle<double>& t) {
    return CertifiedDistance::distance({p, p, p}, t).hi < kernel_width;
}
bool is_in_shape(const Vec3<double>& p, const Shape& shape, const Pose& pose, double width) {
    Pose at;
    at.translation = p;
    return convex::signed_distance(convex::Sphere{0}, at, shape, pose).lo < width;
}

/// One mesh and one shape in one pose, held against all its triangles.
class MeshAndShape {
  public:
    MeshAndShape(const TriangleMesh& mesh, const MeshTree& tree, const Shape& shape,
                 const Pose& pose)
        : mesh_(mesh), tree_(tree), shape_(shape), pose_(pose),
          all_(distances_by_force(mesh, shape, pose)) {
        for (const convex::SignedDistance& d : all_) {
            lo = std::min(lo, d.lo);
            hi = std::min(hi, d.hi);
        }
    }

    void expect_distance(const DistanceOptions& options = {}) const {
        const MeshDistance d = distance(tree_, shape_, pose_, options);
        EXPECT_LE(d.lo, std::max(hi, 0.0));
        EXPECT_GE(d.hi, lo);
        EXPECT_LE(d.lo, d.distance);
        EXPECT_LE(d.distance, d.hi);
        EXPECT_LE(d.hi * (1 - options.relative) - options.absolute,
                  d.lo + d.hi * 0x1p-34 + round_width);
        ASSERT_LT(d.triangles.a, tree_.size());
        EXPECT_EQ(d.triangles.b, 0u);
        EXPECT_TRUE(is_on_triangle(d.point_a, triangle_at(mesh_, d.triangles.a)));
        EXPECT_TRUE(is_in_shape(d.point_b, shape_, pose_, d.hi == 0 ? round_width : kernel_width));
        if (hi < -kernel_width) {
            EXPECT_EQ(d.hi, 0);
        }
        if (d.hi == 0) {
            EXPECT_LE(lo, 0);
            EXPECT_EQ(d.point_a, d.point_b);
        } else {
            EXPECT_NEAR(length(d.point_b - d.point_a), d.distance,
                        8 * std::sqrt(d.hi - d.lo) + 1e-5);
        }
    }

    void expect_decisions() const {
        const Answer touch = collide(tree_, shape_, pose_).answer;
        if (hi < -kernel_width) {
            EXPECT_EQ(touch, Answer::yes);
        }
        if (lo > kernel_width) {
            EXPECT_EQ(touch, Answer::no);
        }
        for (const double tolerance : {.5 * hi, hi - 1e-9, hi + 1e-9, 2 * hi, .1, 9.0}) {
            if (tolerance < 0)
                continue;
            const MeshWithin near = within(tree_, shape_, pose_, tolerance);
            if (hi <= tolerance - kernel_width) {
                EXPECT_TRUE(near.within) << tolerance;
            }
            if (lo > tolerance + kernel_width) {
                EXPECT_FALSE(near.within) << tolerance;
            }
            EXPECT_LE(near.lo, std::max(hi, 0.0));
            EXPECT_GE(near.hi, lo);
        }
    }

    void expect_contacts() const {
        const std::vector<Contact> found = contacts(tree_, shape_, pose_);
        EXPECT_EQ(found.empty(), collide(tree_, shape_, pose_).answer == Answer::no);
        std::vector<bool> touches(all_.size());
        double depth = std::numeric_limits<double>::infinity();
        for (const Contact& c : found) {
            ASSERT_LT(c.triangles.a, all_.size());
            EXPECT_LE(c.depth, depth); // the deepest first
            depth = c.depth;
            const convex::SignedDistance& truth = all_[c.triangles.a];
            touches[c.triangles.a] = true;
            EXPECT_GE(c.depth, -truth.hi - depth_width);
            EXPECT_LE(c.depth, std::max(0.0, -truth.lo) + depth_width);
            // Moved out it is out, but for how well the depth is known.
            Pose out = pose_;
            out.translation = out.translation + c.depth * c.normal;
            EXPECT_GT(
                convex::signed_distance(triangle_at(mesh_, c.triangles.a), Pose{}, shape_, out).hi,
                -(truth.hi - truth.lo) - 1e-6);
        }
        for (std::size_t i = 0; i < all_.size(); ++i) {
            if (all_[i].hi < -kernel_width) {
                EXPECT_TRUE(touches[i]) << i;
            }
            if (all_[i].lo > kernel_width) {
                EXPECT_FALSE(touches[i]) << i;
            }
        }
    }

    double lo = std::numeric_limits<double>::infinity(), hi = lo; ///< less than 0: so deep

  private:
    const TriangleMesh& mesh_;
    const MeshTree& tree_;
    const Shape& shape_;
    const Pose& pose_;
    std::vector<convex::SignedDistance> all_;
};

TEST(MeshShape, AnswersAsAllItsTrianglesDo) {
    ShapesAtRandom shapes(1);
    for (const ShapeKind kind : all_shape_kinds()) {
        SCOPED_TRACE(std::string(to_string(kind)));
        int touching = 0, apart = 0;
        for (std::uint32_t seed = 0; seed < 4; ++seed) {
            const TriangleMesh mesh =
                seed % 2 == 0 ? noisy_sphere(6, 7, .2, seed) : triangle_soup(90, seed);
            const MeshTree tree(mesh, {.volume = seed < 2 ? MeshVolume::obb : MeshVolume::aabb});
            for (int k = 0; k < 12; ++k) {
                const Shape shape = shapes.shape(kind);
                const Pose pose = shapes.pose(k % 3 == 0 ? 4 : 1.5);
                const MeshAndShape both(mesh, tree, shape, pose);
                both.expect_distance();
                both.expect_decisions();
                both.expect_contacts();
                (both.hi <= 0 ? touching : apart)++;
            }
        }
        EXPECT_GT(touching, 3);
        EXPECT_GT(apart, 3);
    }
}

/// Put so near that a gap or a depth is left that is small against all.
TEST(MeshShape, AnswersWhereTheyBarelyTouch) {
    ShapesAtRandom shapes(2);
    const TriangleMesh mesh = noisy_sphere(8, 9, .15, 3);
    const MeshTree tree(mesh);
    for (const ShapeKind kind : all_shape_kinds()) {
        SCOPED_TRACE(std::string(to_string(kind)));
        for (const double gap : {1e-3, 1e-6, 1e-9, 0.0, -1e-9, -1e-6, -1e-3}) {
            const Shape shape = shapes.shape(kind);
            Pose pose = shapes.pose(3);
            const MeshDistance before = distance(tree, shape, pose);
            if (before.hi == 0)
                continue;
            const Vec3<double> way = before.point_a - before.point_b;
            pose.translation = pose.translation + (1 - gap / before.distance) * way;
            const MeshAndShape both(mesh, tree, shape, pose);
            both.expect_distance();
            both.expect_decisions();
            both.expect_contacts();
            EXPECT_GE(both.hi, gap - 1e-5);
            EXPECT_LE(both.hi, std::max(gap, 0.0) + 1e-5); // edges may part another way
        }
    }
}

TEST(MeshShape, LeavesMostTrianglesOut) {
    ShapesAtRandom shapes(3);
    const TriangleMesh mesh = noisy_sphere(60, 60, .02, 1);
    const MeshTree tree(mesh);
    for (const ShapeKind kind : all_shape_kinds()) {
        SCOPED_TRACE(std::string(to_string(kind)));
        Work of_distance, of_collide;
        std::uint64_t queries = 0;
        for (int k = 0; k < 20; ++k) {
            const Shape shape = shapes.shape(kind);
            const Pose pose = shapes.pose(3);
            const Answer touch = collide(tree, shape, pose, &of_collide).answer;
            distance(tree, shape, pose, {}, &of_distance);
            ++queries;
            EXPECT_NE(touch, Answer::maybe);
        }
        EXPECT_LT(of_distance.triangle_tests, queries * mesh.triangles.size() / 30);
        EXPECT_LT(of_collide.triangle_tests, queries * mesh.triangles.size() / 200);
        EXPECT_LT(of_distance.box_tests, queries * mesh.triangles.size() / 10);
        EXPECT_GT(of_distance.node_visits, 0u);
        EXPECT_GT(of_distance.stack_max, 0u);
    }
}

/// Thousands of triangles at the same distance: one is measured, and the others are left out.
TEST(MeshShape, FlatFacesThatAreParallelAreNoTrap) {
    const MeshTree tree(plate(64, 0));
    Pose above;
    above.translation = {.5, .5, 0};
    for (const double gap : {.25, .01, 1e-4})
        for (const Shape& shape :
             {Shape(convex::Box{{.4, .4, .1}}), Shape(convex::Cylinder{.4, .1}),
              Shape(convex::Plane{{0, 0, 1}, -.1})}) {
            above.translation.z = .1 + gap;
            Work work;
            const MeshDistance d = distance(tree, shape, above, {}, &work);
            EXPECT_NEAR(d.distance, gap, 1e-14);
            EXPECT_LT(work.triangle_tests, 60u) << to_string(shape.kind()) << " " << gap;
            EXPECT_LT(work.node_visits, 60u) << to_string(shape.kind()) << " " << gap;
        }
}

TEST(MeshShape, TolerancesSaveWorkAndKeepTheirBound) {
    ShapesAtRandom shapes(4);
    const TriangleMesh mesh = noisy_sphere(20, 20, .1, 1);
    const MeshTree tree(mesh);
    std::uint64_t exact = 0, rough = 0;
    for (const ShapeKind kind : all_shape_kinds())
        for (int k = 0; k < 5; ++k) {
            const Shape shape = shapes.shape(kind);
            const Pose pose = shapes.pose(4);
            const MeshAndShape both(mesh, tree, shape, pose);
            both.expect_distance({.relative = .2});
            both.expect_distance({.absolute = .05});
            if (both.lo <= 0)
                continue;
            DistanceOptions warm;
            warm.start = distance(tree, shape, pose).triangles;
            both.expect_distance(warm);
            Work work;
            distance(tree, shape, pose, {}, &work);
            exact += work.node_visits + work.triangle_tests;
            work = {};
            distance(tree, shape, pose, {.relative = .3}, &work);
            rough += work.node_visits + work.triangle_tests;
            const MeshDistance beyond = distance(tree, shape, pose, {.limit = both.lo * .999});
            EXPECT_FALSE(beyond.found());
            EXPECT_EQ(beyond.lo, both.lo * .999);
            EXPECT_EQ(beyond.hi, std::numeric_limits<double>::infinity());
            EXPECT_TRUE(distance(tree, shape, pose, {.limit = both.hi * 1.001}).found());
        }
    EXPECT_LT(rough, exact * 9 / 10);
}

/// A body and its world moved together, or scaled by powers of two, answer as before.
TEST(MeshShape, AnswersStayUnderCommonMotionsAndScales) {
    ShapesAtRandom shapes(5);
    const TriangleMesh mesh = noisy_sphere(7, 8, .2, 1);
    const MeshTree tree(mesh);
    for (const ShapeKind kind : all_shape_kinds())
        for (int k = 0; k < 6; ++k) {
            const Shape shape = shapes.shape(kind);
            const Pose of_mesh = shapes.pose(1), of_shape = shapes.pose(2.5), move = shapes.pose(9);
            const Pose pose = relative_pose(of_mesh, of_shape);
            const MeshDistance d = distance(tree, shape, pose);
            const MeshDistance moved_too = distance(
                tree, shape, relative_pose(compose(move, of_mesh), compose(move, of_shape)));
            EXPECT_NEAR(d.distance, moved_too.distance, d.distance * 0x1p-34 + kernel_width)
                << to_string(shape.kind());
            EXPECT_EQ(collide(tree, shape, pose).answer == Answer::yes, d.hi == 0);
            if (kind == ShapeKind::sphere)
                for (const double scale : {0x1p-20, 0x1p20}) {
                    TriangleMesh scaled_mesh = mesh;
                    for (Vec3<float>& v : scaled_mesh.vertices)
                        v = static_cast<float>(scale) * v;
                    Pose scaled_pose = pose;
                    scaled_pose.translation = scale * pose.translation;
                    const convex::Sphere ball{scale * shape.get_if<convex::Sphere>()->radius};
                    EXPECT_NEAR(distance(MeshTree(scaled_mesh), ball, scaled_pose).distance / scale,
                                d.distance, kernel_width);
                }
        }
}

TEST(MeshShape, DistanceToHalfSpacesAndPlanesIsThatOfACorner) {
    ShapesAtRandom shapes(6);
    const TriangleMesh mesh = noisy_sphere(9, 9, .2, 4);
    const MeshTree tree(mesh);
    int touching = 0;
    for (int k = 0; k < 50; ++k) {
        const Vec3<double> normal = shapes.vector(3) + Vec3<double>{4, 0, 0};
        const double offset = shapes.real(-9, 9);
        const Pose pose = shapes.pose(2);
        const Vec3<double> n{dot(pose.rotation[0], normal), dot(pose.rotation[1], normal),
                             dot(pose.rotation[2], normal)};
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Vec3<float>& v : mesh.vertices) {
            const double height =
                (dot(n, Vec3<double>(v) - pose.translation) - offset) / length(normal);
            low = std::min(low, height);
            high = std::max(high, height);
        }
        const MeshDistance below = distance(tree, convex::HalfSpace{normal, offset}, pose);
        const MeshDistance off = distance(tree, convex::Plane{normal, offset}, pose);
        EXPECT_NEAR(below.distance, std::max(0.0, low), 1e-13);
        EXPECT_NEAR(off.distance, std::max({0.0, low, -high}), 1e-13);
        touching += below.hi == 0;
    }
    EXPECT_GT(touching, 5);
    EXPECT_LT(touching, 45);
}

/// Certified bounds are as narrow as what is near, wherever the mesh lies.
TEST(MeshShape, FarFromTheOriginBoundsStayNarrow) {
    TriangleMesh mesh = plate(8, 0);
    for (Vec3<float>& v : mesh.vertices)
        v = v + Vec3<float>{0x1p20f, -0x1p19f, 0x1p20f};
    Pose pose;
    pose.translation = {0x1p20 + .5, -0x1p19 + .5, 0x1p20 + .251};
    const MeshDistance d = distance(MeshTree(mesh), convex::Sphere{.25}, pose);
    EXPECT_LT(d.hi - d.lo, 1e-13);
    EXPECT_NEAR(d.distance, .001, 1e-9);
}

TEST(MeshShape, WhatTouchesExactlyIsNeverToldApart) {
    const MeshTree tree(plate(5, 0));
    ShapesAtRandom shapes(7);
    for (int k = 0; k < 40; ++k) {
        const double size = shapes.real(.01, 2);
        Pose on_top;
        on_top.translation = {shapes.real(0, 1), shapes.real(0, 1), size};
        for (const Shape& shape :
             {Shape(convex::Sphere{size}), Shape(convex::Box{{.1, .2, size}}),
              Shape(convex::Cylinder{.3, size}), Shape(convex::Cone{.1, size}),
              Shape(convex::Ellipsoid{{.3, .2, size}}), Shape(convex::HalfSpace{{0, 0, 1}, -size}),
              Shape(convex::Plane{{0, 0, 3}, -3 * size})}) {
            EXPECT_NE(collide(tree, shape, on_top).answer, Answer::no) << to_string(shape.kind());
            EXPECT_TRUE(within(tree, shape, on_top, 0).within) << to_string(shape.kind());
            const MeshDistance d = distance(tree, shape, on_top);
            EXPECT_EQ(d.lo, 0) << to_string(shape.kind());
            EXPECT_LT(d.hi, 1e-7) << to_string(shape.kind());
            EXPECT_FALSE(contacts(tree, shape, on_top).empty()) << to_string(shape.kind());
        }
    }
}

TEST(MeshShape, AMeshInsideASolidTouchesIt) {
    const MeshTree tree(noisy_sphere(5, 6, .1, 1, .1));
    for (const Shape& shape : {Shape(convex::Box{{1, 1, 1}}), Shape(convex::Sphere{1}),
                               Shape(convex::HalfSpace{{0, 0, 1}, 1})}) {
        EXPECT_EQ(collide(tree, shape, Pose{}).answer, Answer::yes);
        EXPECT_EQ(distance(tree, shape, Pose{}).hi, 0);
        const std::vector<Contact> all = contacts(tree, shape, Pose{});
        EXPECT_EQ(all.size(), tree.size());
        EXPECT_GT(all.front().depth, .8);
    }
    EXPECT_EQ(contacts(tree, convex::Sphere{1}, Pose{}, {.max_contacts = 4}).size(), 4u);
    EXPECT_EQ(contacts(tree, convex::Sphere{1}, Pose{}, {.max_pairs = 7}).size(), 7u);
    EXPECT_TRUE(contacts(tree, convex::Sphere{1}, Pose{}, {.max_pairs = 0}).empty());
    // A shape inside a mesh, which is its surface, does not.
    const MeshTree around(noisy_sphere(8, 8, 0, 1, 2));
    EXPECT_EQ(collide(around, convex::Sphere{1}, Pose{}).answer, Answer::no);
}

TEST(MeshShape, DegenerateTrianglesAreSegmentsAndPoints) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {.5f, 0, 0}, {0, 3, 0}};
    mesh.triangles = {{0, 1, 2}, {3, 3, 3}, {0, 0, 1}};
    const MeshTree tree(mesh);
    ShapesAtRandom shapes(8);
    for (const ShapeKind kind : all_shape_kinds())
        for (int k = 0; k < 10; ++k) {
            SCOPED_TRACE(std::string(to_string(kind)));
            const Shape shape = shapes.shape(kind);
            const Pose pose = shapes.pose(2);
            const MeshAndShape both(mesh, tree, shape, pose);
            both.expect_distance();
            both.expect_decisions();
        }
    Pose above;
    above.translation = {0, 3, 2};
    const MeshDistance d = distance(tree, convex::Sphere{.5}, above);
    EXPECT_EQ(d.triangles.a, 1u);
    EXPECT_NEAR(d.distance, 1.5, 1e-14);
}

TEST(MeshShape, NothingIsFarFromEverything) {
    const MeshTree nothing;
    EXPECT_EQ(collide(nothing, convex::Sphere{1}, Pose{}).answer, Answer::no);
    EXPECT_FALSE(distance(nothing, convex::Sphere{1}, Pose{}).found());
    EXPECT_FALSE(within(nothing, convex::Sphere{1}, Pose{}, 5).within);
    EXPECT_TRUE(contacts(nothing, convex::Plane{}, Pose{}).empty());
    EXPECT_EQ(first_contact(nothing, Motion(), convex::Sphere{1}, Motion()).hit, Answer::no);
}

TEST(MeshShape, WhatMakesNoSenseIsRefused) {
    const MeshTree tree(cube_mesh(1));
    const auto is_refused = [&](const Shape& shape, const Pose& pose = {}) {
        EXPECT_THROW(collide(tree, shape, pose), std::invalid_argument);
        EXPECT_THROW(distance(tree, shape, pose), std::invalid_argument);
        EXPECT_THROW(contacts(tree, shape, pose), std::invalid_argument);
    };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double inf = std::numeric_limits<double>::infinity();
    Pose bad;
    bad.translation.y = nan;
    is_refused(convex::Sphere{1}, bad);
    bad = {};
    bad.rotation[1].y = 1.01;
    is_refused(convex::Sphere{1}, bad);
    bad = {};
    bad.translation.x = 0x1p91;
    is_refused(convex::Sphere{1}, bad);
    is_refused(convex::Sphere{-1});
    is_refused(convex::Sphere{nan});
    is_refused(convex::Box{{1, inf, 1}});
    is_refused(convex::Cylinder{1, -2});
    is_refused(convex::Hull{});
    is_refused(convex::HalfSpace{{0, 0, 0}, 1});
    is_refused(convex::Plane{{0, nan, 1}, 1});
    is_refused(convex::Triangle{{0, 0, 0}, {nan, 0, 0}, {0, 1, 0}});
    const convex::Sphere ball{1};
    EXPECT_THROW(distance(tree, ball, Pose{}, {.relative = 1}), std::invalid_argument);
    EXPECT_THROW(distance(tree, ball, Pose{}, {.start = Pair{12, 0}}), std::invalid_argument);
    EXPECT_THROW(distance(tree, ball, Pose{}, {.start = Pair{0, 1}}), std::invalid_argument);
    EXPECT_THROW(within(tree, ball, Pose{}, -1), std::invalid_argument);
    EXPECT_THROW(first_contact(tree, Motion(), ball, Motion(), {.tolerance = nan}),
                 std::invalid_argument);
}

} // namespace
} // namespace boxwood
