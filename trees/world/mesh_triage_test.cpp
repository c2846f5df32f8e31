#include "trees/world/mesh_triage.h"

#include "trees/testing/test_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood {
namespace {

TEST(MeshTriage, FindsNothingWrongWithACube) {
    const TriangleMesh cube = cube_mesh(1);
    const MeshTriage found = triage(cube);
    EXPECT_TRUE(found.is_clean());
    EXPECT_EQ(found.triangles, 12u);
    EXPECT_EQ(found.unused_vertices, 0u);
    EXPECT_EQ(without_bad_triangles(cube, found).triangles, cube.triangles);
    EXPECT_TRUE(triage(noisy_sphere(9, 8, .1, 1)).is_clean());
    EXPECT_TRUE(triage({}).is_clean());
}

TEST(MeshTriage, SetsBadTrianglesAside) {
    TriangleMesh mesh = cube_mesh(1);
    const auto first = mesh.triangles.front();
    mesh.vertices.push_back({0, 0, std::numeric_limits<float>::quiet_NaN()}); // 8
    mesh.vertices.push_back({0, 0, std::numeric_limits<float>::infinity()});  // 9
    mesh.vertices.push_back({7, 7, 7});                                       // 10
    mesh.triangles.push_back({0, 1, 8});                                      // 12
    mesh.triangles.push_back({0, 9, 2});                                      // 13
    mesh.triangles.push_back({0, 1, 11});                                     // 14
    mesh.triangles.push_back({3, 3, 5});                                      // 15
    mesh.triangles.push_back({first[1], first[0], first[2]});                 // 16
    const MeshTriage found = triage(mesh);
    EXPECT_EQ(found.not_finite, (std::vector<std::uint32_t>{12, 13}));
    EXPECT_EQ(found.missing_vertices, (std::vector<std::uint32_t>{14}));
    EXPECT_EQ(found.without_area, (std::vector<std::uint32_t>{15}));
    EXPECT_EQ(found.repeated, (std::vector<std::uint32_t>{16}));
    EXPECT_EQ(found.unused_vertices, 1u);
    EXPECT_TRUE(found.is_closed());
    EXPECT_FALSE(found.is_clean());
    const TriangleMesh good = without_bad_triangles(mesh, found);
    EXPECT_EQ(good.triangles, cube_mesh(1).triangles);
    EXPECT_TRUE(std::ranges::all_of(good.vertices, [](const auto& v) { return is_finite(v); }));
    const std::vector<std::uint32_t> numbers = good_triangles(found);
    ASSERT_EQ(numbers.size(), 12u);
    EXPECT_EQ(numbers.back(), 11u);
}

TEST(MeshTriage, WhatIsTooLargeIsNotBad) {
    TriangleMesh mesh = cube_mesh(1);
    mesh.vertices.front() = mesh.vertices.front() * 0x1p60f;
    const MeshTriage found = triage(mesh);
    std::vector<std::uint32_t> of_it;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        if (std::ranges::count(mesh.triangles[i], 0u))
            of_it.push_back(i);
    EXPECT_EQ(found.too_large, of_it);
    EXPECT_TRUE(found.is_closed());
    EXPECT_FALSE(found.is_clean());
    EXPECT_EQ(good_triangles(found).size(), 12u);
    mesh.vertices.front() = mesh.vertices.front() * 0x1.fffffep-1f;
    EXPECT_TRUE(triage(mesh).is_clean());
}

TEST(MeshTriage, AreaIsExact) {
    // On a line, where rounded arithmetic has room to say otherwise; and a hair off it.
    const float tiny = 0x1p-100f;
    for (const float scale : {1.0f, tiny, 0x1p100f}) {
        const auto at = [&](float x, float y, float z) { return scale * Vec3<float>{x, y, z}; };
        TriangleMesh mesh{{at(.1f, .2f, .3f), at(.2f, .4f, .6f), at(.4f, .8f, 1.2f)}, {{0, 1, 2}}};
        EXPECT_EQ(triage(mesh).without_area.size(), 1u);
        mesh.vertices[2].y = std::nextafter(mesh.vertices[2].y, 0.0f);
        EXPECT_EQ(triage(mesh).without_area.size(), 0u);
    }
}

TEST(MeshTriage, AreaIsExactWhereDoublesRoundProducts) {
    const float hair = 0x1p-30f; // its cross product is -2^-60 + 1 - 1
    const TriangleMesh mesh{{{-1, -1, 0}, {hair, 0, 0}, {0, -hair, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(triage(mesh).without_area.size(), 0u);
}

TEST(MeshTriage, CountsEdgesByPlace) {
    TriangleMesh open = cube_mesh(1);
    open.triangles.pop_back();
    EXPECT_EQ(triage(open).open_edges, 3u);
    TriangleMesh turned = cube_mesh(1);
    std::swap(turned.triangles[4][0], turned.triangles[4][1]);
    EXPECT_EQ(triage(turned).turned_edges, 3u);
    EXPECT_TRUE(triage(turned).is_closed());
    TriangleMesh fin = cube_mesh(1); // a third triangle at an edge
    fin.vertices.push_back({5, 5, 5});
    fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], 8});
    EXPECT_EQ(triage(fin).non_manifold_edges, 1u);
    EXPECT_EQ(triage(fin).open_edges, 2u);
    TriangleMesh apart; // vertices that are not shared by number
    const TriangleMesh cube = cube_mesh(1);
    for (std::size_t i = 0; i < cube.triangles.size(); ++i) {
        const Triangle<float> t = cube.triangle(i);
        const auto n = static_cast<std::uint32_t>(apart.vertices.size());
        apart.vertices.insert(apart.vertices.end(), {t.a, t.b, t.c});
        apart.triangles.push_back({n, n + 1, n + 2});
    }
    EXPECT_TRUE(triage(apart).is_clean());
}

} // namespace
} // namespace boxwood
