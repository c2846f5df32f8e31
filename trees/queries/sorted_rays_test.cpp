#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/queries/sorted_rays.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

namespace boxwood {
namespace {

std::unique_ptr<AnyLayout> layout_of(const LayoutEntry& entry, const TriangleMesh& mesh) {
    return entry.make(make_builder("median")(triangle_boxes(mesh), serial()), serial());
}

/// More than one chunk of the sort, and some rays that have no place in any grid.
std::vector<Ray<float>> many_rays(std::size_t n, float scale) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-2, 2);
    std::vector<Ray<float>> rays;
    for (std::size_t i = 0; i < n; ++i)
        rays.push_back({{place(random) * scale, place(random) * scale, place(random) * scale},
                        {place(random), place(random), place(random)}});
    for (const float odd : {NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 1e-45f, -0.f}) {
        rays.insert(rays.begin() + static_cast<std::ptrdiff_t>(rays.size() / 3),
                    Ray<float>{{odd, 0, -odd}, {1, odd, 0}});
        rays.push_back({{0, 0, 0}, {odd, 0, 1}});
    }
    return rays;
}

bool same_bits(std::span<const RayHit> a, std::span<const RayHit> b) {
    return std::ranges::equal(a, b, [](const RayHit& x, const RayHit& y) {
        return std::bit_cast<std::uint32_t>(x.t) == std::bit_cast<std::uint32_t>(y.t) &&
               std::bit_cast<std::uint32_t>(x.u) == std::bit_cast<std::uint32_t>(y.u) &&
               std::bit_cast<std::uint32_t>(x.v) == std::bit_cast<std::uint32_t>(y.v) &&
               x.triangle == y.triangle;
    });
}

TEST(SortedRays, AnswerBitForBitAsTheRaysOneByOne) {
    const TriangleMesh mesh = triangle_soup(2000);
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        const auto layout = layout_of(entry, mesh);
        const TriangleBlocks triangles = layout->triangles(mesh);
        for (const std::size_t n : {0, 1, 2, 500, 20000}) {
            const std::vector<Ray<float>> rays = n ? many_rays(n, 1) : std::vector<Ray<float>>{};
            for (const RayQuery query : {RayQuery::closest, RayQuery::any}) {
                std::vector<RayHit> single(rays.size());
                layout->rays(rays, query, "watertight", triangles, serial(), single);
                if (n > 500) {
                    EXPECT_GT(std::ranges::count_if(single, &RayHit::hit), 1000);
                }
                for (const auto& [name, executor] : every_executor()) {
                    std::vector<RayHit> hits(rays.size(), RayHit{1, 2, 3, 4});
                    sorted_rays(*layout, rays, query, "watertight", triangles, *executor, hits);
                    EXPECT_TRUE(same_bits(hits, single)) << entry.name << " " << n << " " << name;
                }
            }
        }
    }
}

TEST(SortedRays, AreOrderedByOctantThenAlongTheCurve) {
    for (const float scale : {1.f, 1e30f, 1e-40f}) {
        const std::vector<Ray<float>> rays = many_rays(20000, scale);
        const Box bounds{{-scale, -scale, -scale}, {scale, scale, scale}};
        const Buffer<std::uint32_t> order = ray_order(rays, bounds, serial());
        std::vector<std::uint32_t> all(order.begin(), order.end());
        std::ranges::sort(all);
        for (std::uint32_t i = 0; i < all.size(); ++i)
            ASSERT_EQ(all[i], i);
        const auto octant = [&](std::uint32_t i) {
            const Vec3<float> d = rays[i].direction;
            return std::signbit(d.x) + 2 * std::signbit(d.y) + 4 * std::signbit(d.z);
        };
        EXPECT_TRUE(std::ranges::is_sorted(order, {}, octant));
        for (const unsigned threads : {2u, 4u})
            EXPECT_TRUE(std::ranges::equal(
                order, ray_order(rays, bounds, *make_executor("openmp", threads))));
    }
    // Neighbours in the order start near one another.
    std::vector<Ray<float>> rays = many_rays(20000, .5f);
    std::erase_if(rays, [](const Ray<float>& ray) {
        return !(std::abs(ray.origin.x) <= 1) || !is_finite(ray.direction);
    });
    const Buffer<std::uint32_t> order = ray_order(rays, {{-1, -1, -1}, {1, 1, 1}}, serial());
    double given = 0, sorted = 0;
    for (std::size_t i = 1; i < rays.size(); ++i) {
        given += static_cast<double>(length(rays[i].origin - rays[i - 1].origin));
        sorted += static_cast<double>(length(rays[order[i]].origin - rays[order[i - 1]].origin));
    }
    EXPECT_LT(sorted, given / 5);
}

TEST(SortedRays, FromOutsideAreOrderedByWhereTheyComeIn) {
    std::vector<Ray<float>> rays; // down at a square from one far point
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(0, 1);
    for (int i = 0; i < 4000; ++i)
        rays.push_back(
            {{-1, -1, 9}, Vec3<float>{place(random), place(random), 1} - Vec3<float>{-1, -1, 9}});
    const Buffer<std::uint32_t> order = ray_order(rays, {{0, 0, 0}, {1, 1, 1}}, serial());
    double given = 0, sorted = 0;
    for (std::size_t i = 1; i < rays.size(); ++i) {
        given += static_cast<double>(length(rays[i].direction - rays[i - 1].direction));
        sorted +=
            static_cast<double>(length(rays[order[i]].direction - rays[order[i - 1]].direction));
    }
    EXPECT_LT(sorted, given / 8);
}

TEST(SortedRays, StayAsTheyCameFromOnePointInside) {
    std::vector<Ray<float>> rays;
    for (int i = 0; i < 1000; ++i)
        rays.push_back({{1, 2, 3}, {1, static_cast<float>(i), 1}});
    const Buffer<std::uint32_t> order = ray_order(rays, {{0, 0, 0}, {4, 4, 4}}, serial());
    EXPECT_TRUE(std::ranges::is_sorted(order));
}

TEST(SortedRays, RefuseWrongArguments) {
    const TriangleMesh mesh = triangle_soup(10);
    const auto layout = layout_of(find_layout("wide8"), mesh);
    const TriangleBlocks triangles = layout->triangles(mesh);
    const std::vector<Ray<float>> rays(3, Ray<float>{{0, 0, 0}, {1, 0, 0}});
    std::vector<RayHit> hits(3), few(2);
    EXPECT_THROW(sorted_rays(*layout, rays, RayQuery::any, "nonsense", triangles, serial(), hits),
                 std::invalid_argument);
    EXPECT_THROW(sorted_rays(*layout, rays, RayQuery::any, "watertight", triangles, serial(), few),
                 std::invalid_argument);
}

} // namespace
} // namespace boxwood
