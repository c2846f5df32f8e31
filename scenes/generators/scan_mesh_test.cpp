#include "scenes/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

namespace boxwood {
namespace {

TEST(ScanMesh, HasHolesAndUnevenTriangles) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        const TriangleMesh mesh =
            make_scene({.generator = "scan_mesh", .n = 20'000, .seed = seed}).mesh;
        EXPECT_GT(mesh.triangles.size(), 17'000u);
        EXPECT_LT(mesh.triangles.size(), 20'000u);
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges; // directed
        std::vector<double> areas;
        std::vector<std::uint8_t> is_used(mesh.vertices.size());
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                ++edges[{mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]}];
                is_used[mesh.triangles[i][k]] = 1;
            }
            const Triangle<float> t = mesh.triangle(i);
            areas.push_back(length(cross(Vec3<double>(t.b) - Vec3<double>(t.a),
                                         Vec3<double>(t.c) - Vec3<double>(t.a))));
        }
        std::size_t open = 0;
        for (const auto& [edge, count] : edges) {
            ASSERT_EQ(count, 1);
            open += !edges.contains({edge.second, edge.first});
        }
        EXPECT_GT(open, 100u);
        EXPECT_EQ(std::ranges::count(is_used, 0), 0);
        std::ranges::sort(areas);
        EXPECT_GT(areas.front(), 0);
        EXPECT_GT(areas[areas.size() * 99 / 100], 10 * areas[areas.size() / 100]);
    }
}

TEST(ScanMesh, ATinyOneIsWhole) {
    EXPECT_EQ(make_scene({.generator = "scan_mesh", .n = 8}).mesh.triangles.size(), 8u);
}

} // namespace
} // namespace boxwood
