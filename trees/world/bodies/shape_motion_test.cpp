#include "kernels/convex/motion.h"
#include "kernels/triangle_distance/features.h"
#include "trees/testing/test_bodies.h"
#include "trees/testing/test_meshes.h"
#include "trees/world/bodies/detail/swept_box.h"
#include "trees/world/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace boxwood {
namespace {

/// A mesh and a box in one place go the same way, however near half a turn.
TEST(ShapeMotions, OfMeshesAndConvexShapesAreOne) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-2, 2), exponent(-17, -1);
    const BodyShape box(convex::Box{{1, 2, 3}});
    for (int k = 0; k < 4000; ++k) {
        const Pose from = random_pose(random, {place(random), place(random), place(random)});
        Vec3<double> axis{place(random), place(random), place(random)};
        if (k % 3 == 0)
            axis = {k % 2 ? 1. : 0., k % 2 ? 0. : 1., 0};
        axis = axis * (1 / length(axis));
        const double less = k % 5 ? std::pow(10, exponent(random)) : 0;
        const double angle = (k % 4 < 2 ? 1 : -1) * (std::numbers::pi - less);
        Pose to = from;
        to.rotation = product(rotation_about(axis, angle), from.rotation);
        to.translation = to.translation + Vec3<double>{place(random), 0, place(random)};
        for (const MotionPath path : {MotionPath::linear, MotionPath::screw}) {
            const Motion motion(from, to, path);
            const convex::Motion other = detail::convex_motion({box, from, to, path});
            for (const double t : {.25, .5, 1.})
                for (const Vec3<double> p : {Vec3<double>{0, 0, 0}, Vec3<double>{1, -2, 3}})
                    ASSERT_LT(length(motion.at(t)(p) - convex::pose_at(other, t)(p)), 1e-13)
                        << k << " at " << t;
            ASSERT_LT(length(convex::pose_at(other, 1)({1, -2, 3}) - to({1, -2, 3})), 1e-13);
        }
    }
}

/// At the time of the contact, and of each mesh its own.
TEST(ShapeMotions, NameTheTrianglesThatTouch) {
    std::mt19937 random(2);
    const TriangleMesh cube = cube_mesh(1);
    TriangleMesh tetrahedron;
    tetrahedron.vertices = {{-1, -1, 0}, {1, -1, .5f}, {0, 1, 0}, {0, 0, 1}};
    tetrahedron.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
    const BodyShape a = BodyShape::surface(cube), b = BodyShape::surface(tetrahedron);
    const auto placed = [](const TriangleMesh& mesh, std::uint32_t triangle, const Pose& pose) {
        const Triangle<float> t = mesh.triangle(triangle);
        return Triangle<double>{pose(Vec3<double>(t.a)), pose(Vec3<double>(t.b)),
                                pose(Vec3<double>(t.c))};
    };
    for (int k = 0; k < 200; ++k) {
        const double margin = k % 2 ? .125 : 0;
        const MotionPath path = k % 4 < 2 ? MotionPath::linear : MotionPath::screw;
        const Pose still = random_pose(random, {0, 0, 0}), from = random_pose(random, {5, 0, 0}),
                   to = random_pose(random, {0, 0, 0});
        const FirstContact found = first_contact(MovingShape{a, still, still, path, margin},
                                                 {b, from, to, path}, {.tolerance = 1e-6});
        ASSERT_EQ(found.hit, Answer::yes) << k;
        ASSERT_LT(found.triangles.a, cube.triangles.size());
        ASSERT_LT(found.triangles.b, tetrahedron.triangles.size());
        const Pose then = Motion(from, to, path).at(found.t_hit);
        EXPECT_NEAR(FeaturesF64::distance(placed(cube, found.triangles.a, still),
                                          placed(tetrahedron, found.triangles.b, then))
                        .distance,
                    margin, 1e-5)
            << k;
    }
}

} // namespace
} // namespace boxwood
