#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/queries/tiled_rays.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/ray_scenes.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood {
namespace {

/// n rays from one eye, row by row.
std::vector<Ray<float>> picture(std::size_t n, std::size_t width) {
    std::vector<Ray<float>> rays;
    const float step = 1.2f / static_cast<float>(width);
    for (std::size_t i = 0; i < n; ++i)
        rays.push_back({{.1f, .2f, 3},
                        {static_cast<float>(i % width) * step - .6f,
                         static_cast<float>(i / width) * step - .6f, -1}});
    return rays;
}

TEST(TiledRays, AnswerAsTheRaysInTheirOrder) {
    const TriangleMesh mesh = sphere(24);
    const Tree tree = make_builder("median")(triangle_boxes(mesh), serial());
    // Whole tiles, tiles that reach beyond the picture, rows that are not whole, less than a tile.
    const std::pair<std::size_t, std::size_t> pictures[] = {
        {64 * 64, 64}, {61 * 61, 61}, {3000, 55}, {3001, 54}, {7, 3}, {5, 100}, {1, 1}, {0, 8}};
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        const auto layout = entry.make(tree, serial());
        const TriangleBlocks triangles = layout->triangles(mesh);
        for (const auto& [n, width] : pictures) {
            const std::vector<Ray<float>> rays = picture(n, width);
            for (const RayQuery query : {RayQuery::closest, RayQuery::any}) {
                std::vector<RayHit> expected(n);
                for (std::size_t i = 0; i < n; ++i)
                    layout->rays(std::span(rays).subspan(i, 1), query, "watertight", triangles,
                                 serial(), std::span(expected).subspan(i, 1));
                if (n > 1000) {
                    EXPECT_GT(std::ranges::count_if(expected, &RayHit::hit), 500);
                }
                for (const auto& [name, executor] : every_executor()) {
                    SCOPED_TRACE(std::string(entry.name) + " " + std::string(name));
                    std::vector<RayHit> hits(n, RayHit{1, 2, 3, 4});
                    tiled_rays(*layout, rays, width, query, "watertight", triangles, *executor,
                               hits);
                    for (std::size_t i = 0; i < n; ++i) {
                        ASSERT_EQ(hits[i].hit(), expected[i].hit()) << i;
                        if (query == RayQuery::closest) {
                            ASSERT_EQ(hits[i], expected[i]) << i;
                        }
                    }
                }
            }
        }
    }
}

TEST(TiledRays, RefuseWrongArguments) {
    const TriangleMesh mesh = triangle_soup(10);
    const auto layout =
        find_layout("wide8").make(make_builder("median")(triangle_boxes(mesh), serial()), serial());
    const TriangleBlocks triangles = layout->triangles(mesh);
    const std::vector<Ray<float>> rays = picture(3, 3);
    std::vector<RayHit> hits(3), few(2);
    const auto tiled = [&](std::size_t width, std::string_view kernel, std::span<RayHit> out) {
        tiled_rays(*layout, rays, width, RayQuery::any, kernel, triangles, serial(), out);
    };
    EXPECT_THROW(tiled(0, "watertight", hits), std::invalid_argument);
    EXPECT_THROW(tiled(3, "nonsense", hits), std::invalid_argument);
    EXPECT_THROW(tiled(3, "watertight", few), std::invalid_argument);
}

} // namespace
} // namespace boxwood
