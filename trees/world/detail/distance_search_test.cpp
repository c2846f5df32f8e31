#include "trees/world/mesh_pairs.h"

#include "kernels/arithmetic/float_mode.h"
#include "trees/testing/all_pairs.h"
#include "trees/testing/test_meshes.h"
#include "trees/world/box_mesh.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>

namespace boxwood {
namespace {

TEST(DistanceSearch, WhatTheQueueHasNoRoomForIsLookedAtAtOnce) {
    // Nearly equal distances all around: none of the pairs of blocks can be left out early.
    for (const std::uint32_t seed : {1u, 2u, 3u, 4u}) {
        const TriangleMesh a = noisy_sphere(32, 32, 1e-3, seed),
                           b = noisy_sphere(32, 32, 1e-3, seed + 9, 1.05);
        const MeshTree inner(a), outer(b);
        Work work;
        const MeshDistance d = distance(inner, outer, Pose{}, {}, &work);
        EXPECT_GT(work.stack_max, 1024u);
        const Bounds truth = distance_of_all_pairs(a, b, Pose{});
        expect_between(d, truth);
        for (const double more : {1e-9, 1e-6, 1e-3, .1}) {
            EXPECT_TRUE(within(inner, outer, Pose{}, d.hi * (1 + more)).within);
            EXPECT_FALSE(within(inner, outer, Pose{}, d.lo * (1 - more)).within);
            expect_between(distance(inner, outer, Pose{}, {.limit = d.hi * (1 + more)}), truth);
            EXPECT_FALSE(distance(inner, outer, Pose{}, {.limit = d.lo * (1 - more)}).found());
        }
        for (std::size_t vertex = 20; vertex < b.vertices.size(); vertex += 90) {
            TriangleMesh spiked = b;
            spiked.vertices[vertex] = .9f * spiked.vertices[vertex];
            EXPECT_EQ(distance(inner, MeshTree(spiked), Pose{}).hi, 0);
        }
    }
}

TEST(DistanceSearch, GoesStraightToWhatIsNearEnough) {
    // Many boxes overlap, and any pair of triangles that is near enough will do.
    std::uint64_t tests = 0;
    for (const std::uint32_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
        const MeshTree a(noisy_sphere(60, 60, .01, seed)), b(noisy_sphere(60, 60, .01, seed + 9));
        const Pose pose{.translation = {1.2, 1.2, 1.2}};
        const double d = distance(a, b, pose).hi;
        for (const double more : {1.01, 1.1, 1.3, 1.6}) {
            Work work;
            EXPECT_TRUE(within(a, b, pose, more * d, &work).within);
            tests += work.box_tests;
        }
    }
    EXPECT_LT(tests, 9000u); // 5,976; best first: 16,056; unordered: 11,408
}

TEST(DistanceSearch, OfTouchingMeshesIsWithinNothingWhateverTheCallersFloatMode) {
    const MeshTree cube(cube_mesh(1)), ball(noisy_sphere(12, 12, .1, 1)), nothing;
    Pose beside;
    beside.translation.x = 2; // a face on a face
    for (const bool flushing : {false, true}) {
        const DenormalFlushing mode(flushing);
        EXPECT_TRUE(within(cube, cube, beside, 0).within);
        EXPECT_TRUE(within(cube, ball, {.translation = {1.5, 0, 0}}, 0).within);
        EXPECT_TRUE(within(cube, cube, beside, std::numeric_limits<double>::infinity()).within);
        EXPECT_TRUE(within(cube, cube, Pose{}, 1e-310).within);
        EXPECT_FALSE(within(cube, nothing, beside, 1).within);
        EXPECT_FALSE(within(nothing, cube, beside, 0).within);
    }
    Pose apart = beside;
    apart.translation.x += 1e-12;
    EXPECT_FALSE(within(cube, cube, apart, 0).within);
    EXPECT_TRUE(within(cube, cube, apart, 1e-11).within);
}

} // namespace
} // namespace boxwood
