#include "trees/world/detail/bounding_sphere.h"

#include "kernels/oracle/oracle.h"
#include "kernels/primitives/rotation.h"
#include "trees/testing/all_pairs.h"
#include "trees/testing/test_meshes.h"
#include "trees/world/mesh_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace boxwood {
namespace {

using detail::are_separated;
using detail::BoundingSphere;

bool touch_by_rationals(const TriangleMesh& a, const TriangleMesh& b, const Pose& pose) {
    for (std::uint32_t i = 0; i < a.triangles.size(); ++i)
        for (std::uint32_t j = 0; j < b.triangles.size(); ++j)
            if (oracle::intersect(triangle_at(a, i), triangle_at(b, j, pose)))
                return true;
    return false;
}

TEST(BoundingSpheres, SeparateMeshesOnlyWhereTheyAreApart) {
    const auto tip = [](double scale) { // an octahedron: its corners lie on its sphere
        const auto s = static_cast<float>(scale);
        TriangleMesh mesh;
        mesh.vertices = {{s, 0, 0}, {-s, 0, 0}, {0, s, 0}, {0, -s, 0}, {0, 0, s}, {0, 0, -s}};
        for (const std::uint32_t x : {0u, 1u})
            for (const std::uint32_t y : {2u, 3u})
                for (const std::uint32_t z : {4u, 5u})
                    mesh.triangles.push_back({x, y, z});
        return mesh;
    };
    std::mt19937 random(5);
    std::uniform_real_distribution<double> exponent(-50, -1), sizes(-20, 20),
        stretched(-0x1p-14, 0x1p-14);
    std::size_t touch = 0, by_spheres = 0;
    for (int k = 0; k < 2000; ++k) {
        const double size_a = std::exp2(sizes(random)), size_b = std::exp2(sizes(random));
        const TriangleMesh mesh_a = tip(size_a), mesh_b = tip(size_b);
        const MeshTree a(mesh_a), b(mesh_b);
        Pose pose; // a corner of B near the one of A; half of the matrices are not quite rotations
        if (k % 2 == 1)
            for (Vec3<double>& row : pose.rotation)
                row = row + Vec3{stretched(random), stretched(random), stretched(random)};
        const double gap = k % 3 == 0 ? 0 : std::exp2(exponent(random)) * (size_a + size_b);
        pose.translation =
            Vec3<double>(mesh_a.vertices[0]) - pose.rotated(Vec3<double>(mesh_b.vertices[1]));
        pose.translation.x += k % 3 == 1 ? -gap : gap;
        const bool expected = touch_by_rationals(mesh_a, mesh_b, pose);
        Work work;
        ASSERT_EQ(collide(a, b, pose, &work), expected) << k;
        ASSERT_EQ(touching_triangles(a, b, pose).empty(), !expected) << k;
        ASSERT_FALSE(near_triangles(a, b, pose, gap + 0x1p-45 * (size_a + size_b)).empty()) << k;
        touch += expected;
        by_spheres += work.box_tests == 0;
    }
    EXPECT_GT(touch, 1000u);
    EXPECT_GT(by_spheres, 100u);
}

/// Far from the origins of their frames, and under matrices that are not quite rotations: a corner
/// of A on its sphere, and one of B that is moved onto it, or as near as rounding allows.
TEST(BoundingSpheres, HoldTheirCornersAsTheyAreMoved) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi), exponent(0, 40),
        component(-1, 1);
    std::size_t close = 0;
    for (int k = 0; k < 20000; ++k) {
        const double far = std::exp2(exponent(random));
        const auto on_circle = [&] {
            const double at = angle(random);
            return Vec3<double>{0, std::cos(at), std::sin(at)};
        };
        const Vec3<double> out = on_circle(), of_b = on_circle();
        const BoundingSphere a{{far, 0, 0}, length(out) * (1 + 0x1p-52), far + 2},
            b{{far, 0, 0}, length(of_b) * (1 + 0x1p-52), far + 2};
        // Turns of_b to -out, about the axis between them and then about -out.
        const Vec3<double> from = 1 / length(of_b) * of_b, to = -1 / length(out) * out;
        Pose pose;
        pose.rotation = rotation_about(
            {1, 0, 0}, std::atan2(from.y * to.z - from.z * to.y, from.y * to.y + from.z * to.z));
        pose.rotation = product(rotation_about(to, angle(random)), pose.rotation);
        if (k % 2 == 1) {
            const double skew = std::exp2(-16 - .6 * exponent(random));
            for (Vec3<double>& row : pose.rotation)
                row = row + skew * Vec3{component(random), component(random), component(random)};
        }
        const Vec3<double> corner = a.centre + out;
        pose.translation = corner - pose.rotated(b.centre + of_b);
        const Vec3<double> miss = pose(b.centre + of_b) - corner;
        const double gap = length(miss) * (1 + 0x1p-40);
        ASSERT_FALSE(are_separated(a, b, pose, gap)) << k;
        Pose apart = pose;
        apart.translation = pose.translation - 0x1p-8 * to;
        close += are_separated(a, b, apart, gap);
    }
    EXPECT_GT(close, 8000u);
}

TEST(BoundingSpheres, AndPosesThatAreNoneThrowHoweverFarApart) {
    const MeshTree a(noisy_sphere(6, 7, .3, 1));
    for (const double bad : {std::nan(""), HUGE_VAL, 0x1p63})
        for (int axis = 0; axis < 3; ++axis) {
            Pose pose;
            pose.translation[axis] = bad;
            EXPECT_THROW(collide(a, a, pose), std::invalid_argument);
            EXPECT_THROW(near_triangles(a, a, pose, 1), std::invalid_argument);
            pose = {};
            pose.rotation[static_cast<std::size_t>(axis)][0] = bad;
            pose.translation.x = 100;
            EXPECT_THROW(touching_triangles(a, a, pose), std::invalid_argument);
        }
    for (const double scale : {.5, 1 - 0x1p-11, 1 + 0x1p-11, 2.})
        for (const double far : {0., 100.}) {
            Pose pose;
            for (int axis = 0; axis < 3; ++axis)
                pose.rotation[static_cast<std::size_t>(axis)][axis] = scale;
            pose.translation.x = far;
            EXPECT_THROW(collide(a, a, pose), std::invalid_argument);
            EXPECT_THROW(distance(a, a, pose), std::invalid_argument);
        }
}

} // namespace
} // namespace boxwood
