#include "trees/dynamic/ray_refit.h"
#include "trees/layout.h"

#include "kernels/ray_triangle/watertight.h"
#include "trees/builder.h"
#include "trees/testing/brute_force_rays.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace boxwood {
using namespace detail;
namespace {

std::vector<Ray<float>> some_rays() {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-2, 2);
    std::vector<Ray<float>> rays;
    for (int i = 0; i < 300; ++i) {
        const Vec3<float> from{place(random), place(random), place(random)};
        rays.push_back(
            {from, Vec3<float>{place(random) / 4, place(random) / 4, place(random) / 4} - from});
    }
    return rays;
}

std::vector<Box> boxes_of(const TriangleMesh& mesh) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        boxes.push_back(mesh.triangle(i).bounds());
    return boxes;
}

/// A run of the triangles elsewhere, larger or smaller: of one, of some, or of all.
std::pair<std::size_t, std::size_t> move_some(TriangleMesh& mesh, std::mt19937& random) {
    const std::size_t n = mesh.triangles.size();
    std::uniform_real_distribution<float> by(-.5f, .5f);
    const std::size_t length = std::min<std::size_t>(n, std::size_t{1} << random() % 14);
    const std::size_t first = random() % (n - length + 1);
    const Vec3<float> shift{by(random), by(random), by(random)};
    const float scale = 1 + by(random);
    for (std::size_t v = 3 * first; v < 3 * (first + length); ++v)
        mesh.vertices[v] = mesh.vertices[v] * scale + shift;
    return {first, first + length};
}

void expect_followed(std::string_view layout, std::string_view builder) {
    const auto rays = some_rays();
    std::size_t hit = 0;
    for (const std::uint32_t n : {1u, 7u, 8u, 9u, 16u, 17u, 40u, 257u, 3000u}) {
        SCOPED_TRACE(std::string(layout) + ", " + std::to_string(n) + " triangles");
        TriangleMesh mesh = triangle_soup(n);
        Tree tree;
        const auto made = make_layout(find_layout(layout), make_builder(std::string(builder)),
                                      boxes_of(mesh), serial(), tree);
        TriangleBlocks blocks = made->triangles(mesh);
        RayRefit refit;
        refit.start(blocks, n);
        const double fresh = RayRefit::surface(blocks);
        std::mt19937 random(n);
        for (int frame = 0; frame < 12; ++frame) {
            for (unsigned runs = random() % 4; runs-- > 0;) {
                const auto [first, last] = move_some(mesh, random);
                refit.note(first, last);
            }
            refit.refit(blocks, mesh, serial());
            Box all;
            for (const Box& box : boxes_of(mesh))
                all.extend(box);
            EXPECT_EQ(blocks.bounds, all);
            std::vector<RayHit> found(rays.size());
            made->rays(rays, RayQuery::closest, "watertight", blocks, serial(), found);
            EXPECT_EQ(found, brute_force<Watertight>(mesh, rays)) << "frame " << frame;
            hit += static_cast<std::size_t>(std::ranges::count_if(found, &RayHit::hit));
        }
        if (n > 16)
            EXPECT_GT(fresh, 0);
        else
            EXPECT_EQ(fresh, 0);
    }
    EXPECT_GT(hit, 1000u);
}

TEST(RayRefit, AnswersAreThoseOfBruteForce) {
    expect_followed("wide16", "binned_sah");
    expect_followed("wide16", "median");
    expect_followed("packed", "hilbert");
}

// Whatever changed and on whatever executor, the tree is byte for byte what the same order makes of
// the mesh as it is.
TEST(RayRefit, MakesTheTreeOfTheSameOrderAgain) {
    for (const auto& [name, run] : every_executor()) {
        SCOPED_TRACE(name);
        TriangleMesh mesh = triangle_soup(5000);
        const auto order = make_builder("hilbert").order(boxes_of(mesh), serial());
        const auto rebuilt = [&] {
            const std::vector<Box> boxes = boxes_of(mesh);
            return find_layout("packed")
                .make_of_order(boxes, order.span(), serial())
                ->triangles(mesh);
        };
        TriangleBlocks blocks = rebuilt();
        RayRefit refit;
        refit.start(blocks, 5000);
        std::mt19937 random(1);
        for (int frame = 0; frame < 8; ++frame) {
            const auto [first, last] = move_some(mesh, random);
            refit.note(first, last);
            refit.refit(blocks, mesh, *run);
            const TriangleBlocks expected = rebuilt();
            EXPECT_TRUE(std::ranges::equal(blocks.nodes.span(), expected.nodes.span()));
            EXPECT_TRUE(std::ranges::equal(blocks.blocks.span(), expected.blocks.span()));
            EXPECT_EQ(blocks.bounds, expected.bounds);
            EXPECT_EQ(RayRefit::surface(blocks), RayRefit::surface(expected));
        }
    }
}

// Two triangles far apart in a leaf each: the sum is that of their boxes.
TEST(RayRefit, SurfaceIsThatOfAllBoxesButTheRoots) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 17; ++i) { // the last by itself
        const float x = i == 16 ? 98 : 0;
        for (const Vec3<float> corner :
             {Vec3<float>{x, 0, 0}, Vec3<float>{x + 2, 1, 0}, Vec3<float>{x, 0, 3}})
            mesh.vertices.push_back(corner);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    Tree tree;
    const auto made = make_layout(find_layout("wide16"), make_builder("binned_sah"), boxes_of(mesh),
                                  serial(), tree);
    EXPECT_DOUBLE_EQ(RayRefit::surface(made->triangles(mesh)),
                     2. * (2 * 1 + 1 * 3 + 3 * 2) / (100 * 1 + 1 * 3 + 3 * 100));
    EXPECT_EQ(RayRefit::surface({}), 0);
}

} // namespace
} // namespace boxwood
