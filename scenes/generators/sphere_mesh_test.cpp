#include "scenes/scene.h"

#include <gtest/gtest.h>

#include <map>

namespace boxwood {
namespace {

TriangleMesh sphere(std::size_t n, std::uint64_t seed = 1) {
    return make_scene({.generator = "sphere_mesh", .n = n, .seed = seed}).mesh;
}

TEST(SphereMesh, IsAClosedOrientedSurface) {
    for (const std::size_t n : {1u, 8u, 32u, 72u, 200u, 5000u}) {
        const TriangleMesh mesh = sphere(n);
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges; // directed
        for (const auto& t : mesh.triangles)
            for (std::size_t k = 0; k < 3; ++k)
                ++edges[{t[k], t[(k + 1) % 3]}];
        for (const auto& [edge, count] : edges) {
            ASSERT_EQ(count, 1);
            ASSERT_TRUE(edges.contains({edge.second, edge.first}));
        }
        // Euler: V - E + F = 2; every vertex is used, since each fan is closed and V is as
        // expected.
        EXPECT_EQ(mesh.vertices.size() + mesh.triangles.size() - edges.size() / 2, 2u) << n;
    }
}

TEST(SphereMesh, FacesOutwardAndIsBumpy) {
    const TriangleMesh mesh = sphere(5000);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) { // star-shaped: seen from 0, all backs
        const Triangle<float> t = mesh.triangle(i);
        const auto a = Vec3<double>(t.a), b = Vec3<double>(t.b), c = Vec3<double>(t.c);
        ASSERT_GT(dot(a, cross(b, c)), 0) << i;
    }
    float low = 9, high = 0;
    for (const Vec3<float>& v : mesh.vertices) {
        low = std::min(low, length(v));
        high = std::max(high, length(v));
    }
    EXPECT_GT(low, 0.85f);
    EXPECT_LT(high, 1.15f);
    EXPECT_GT(high - low, 0.08f);
    EXPECT_NE(mesh.vertices, sphere(5000, 2).vertices);
}

TEST(SphereMesh, HasAboutAsManyTrianglesAsWanted) {
    for (const std::size_t n : {1000u, 10000u, 100000u})
        EXPECT_NEAR(static_cast<double>(sphere(n).triangles.size()) / static_cast<double>(n), 1,
                    0.05);
}

} // namespace
} // namespace boxwood
