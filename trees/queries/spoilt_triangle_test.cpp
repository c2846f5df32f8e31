#include "kernels/registry.h"
#include "trees/testing/append_hits.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

/// Boxes and mesh files with a NaN are refused by index. What is left is a vertex that becomes one
/// after the tree was built: the ray kernels set its triangle aside, and it may hide no other, in
/// its block of triangles least of all.
namespace boxwood {
namespace {

constexpr std::uint32_t n = 300;

TEST(SpoiltTriangle, HidesNoOtherFromARay) {
    const TriangleMesh good = triangle_soup(n);
    const Tree tree = make_builder("binned_sah")(triangle_boxes(good), serial());
    std::vector<Ray<float>> rays; // through the middle of each triangle
    for (std::uint32_t i = 0; i < n; ++i) {
        const Triangle<float> t = good.triangle(i);
        const Vec3<float> middle = (t.a + t.b + t.c) * (1.f / 3);
        rays.push_back({middle - Vec3<float>{3, 2, 1}, {3, 2, 1}});
    }
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        for (const LayoutEntry& entry : layouts_answering({Query::rays}))
            for (const KernelInfo& kernel : ray_kernels()) {
                SCOPED_TRACE(std::string(entry.name) + ", " + std::string(kernel.name));
                const auto layout = entry.make(tree, serial());
                const auto hits_of = [&](const TriangleMesh& mesh) {
                    AppendHits hits;
                    layout->rays_all(rays, kernel.name, layout->triangles(mesh), serial(), hits);
                    return hits.all;
                };
                auto expected = hits_of(good);
                TriangleMesh spoilt = good;
                for (std::uint32_t i = 0; i < n; i += 7)
                    spoilt.vertices[3 * i + i % 3].y = bad;
                std::erase_if(expected,
                              [](const auto& hit) { return hit.second.triangle % 7 == 0; });
                EXPECT_GT(expected.size(), n / 2);
                EXPECT_EQ(hits_of(spoilt), expected);
                std::vector<RayHit> closest(n), any(n);
                const TriangleBlocks triangles = layout->triangles(spoilt);
                layout->rays(rays, RayQuery::closest, kernel.name, triangles, serial(), closest);
                layout->rays(rays, RayQuery::any, kernel.name, triangles, serial(), any);
                std::vector<RayHit> first(n);
                for (auto hit = expected.rbegin(); hit != expected.rend(); ++hit)
                    first[hit->first] = hit->second;
                for (std::uint32_t i = 0; i < n; ++i) {
                    EXPECT_EQ(closest[i], first[i]);
                    EXPECT_EQ(any[i].hit(), first[i].hit());
                }
            }
}

TEST(SpoiltTriangle, HidesNoOtherFromAPoint) {
    const TriangleMesh good = triangle_soup(n);
    const Tree tree = make_builder("binned_sah")(triangle_boxes(good), serial());
    TriangleMesh spoilt = good;
    std::vector<Vec3<float>> points;
    std::vector<std::uint32_t> own;
    for (std::uint32_t i = 0; i < n; ++i)
        if (i % 7 == 0) {
            spoilt.vertices[3 * i + i % 3].y = std::numeric_limits<float>::quiet_NaN();
        } else {
            points.push_back(good.vertices[3 * i]);
            own.push_back(i);
        }
    for (const LayoutEntry& entry : layouts_answering({Query::closest_points})) {
        std::vector<SurfacePoint> near(points.size());
        entry.make(tree, serial())->closest_points(points, spoilt, serial(), near);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_EQ(near[i].triangle, own[i]) << entry.name;
            EXPECT_EQ(near[i].squared_distance, 0) << entry.name;
        }
    }
}

} // namespace
} // namespace boxwood
