#include "kernels/registry.h"
#include "trees/builder.h"
#include "trees/builders/hilbert.h"
#include "trees/cuda/queries/packed_queries.cuh"
#include "trees/cuda/testing/families.h"
#include "trees/cuda/testing/packed_layout.h"
#include "trees/layout.h"
#include "trees/testing/ray_scenes.h"
#include "trees/testing/region_queries.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace boxwood::cuda {
namespace {

MadePackedLayout made_of(Boxes boxes) {
    return {boxes, HilbertBuilder{}.order(boxes, serial()).span()};
}

/// The first and last queries of some kind, and some of those between.
template <class Region> std::vector<Region> some(const std::vector<Region>& all) {
    std::vector<Region> few;
    for (std::size_t i = 0; i < all.size(); i += i < 5 || i + 7 > all.size() ? 1 : 12)
        few.push_back(all[i]);
    return few;
}

/// By parts of each level, and each kind of pass.
template <class Region>
void expect_found(const BoxFamily& family, const std::vector<Region>& regions,
                  const std::vector<Pair>& wanted, std::uint64_t seeds) {
    const MadePackedLayout made = made_of(family.boxes);
    const auto n = static_cast<std::uint32_t>(regions.size());
    for (unsigned level = 0; level < made.view.depth; ++level) {
        const std::uint32_t parts = made.view.size(level);
        if (std::size_t{parts} * n > 300) // leaves of the large ones
            continue;
        std::vector<std::uint32_t> first;
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            on_host::set_seed(seed);
            std::vector<std::uint64_t> at(std::size_t{parts} * n + 1);
            find_in_regions<Pass::count>(made.view, level, regions.data(), n,
                                         {at.data(), nullptr, 0}, {});
            std::exclusive_scan(at.begin(), at.end(), at.begin(), std::uint64_t{0});
            std::vector<std::uint32_t> items(at.back());
            find_in_regions<Pass::fill>(made.view, level, regions.data(), n,
                                        {at.data(), items.data(), 0}, {});
            if (seed > 0) {
                ASSERT_EQ(items, first) << "the order depends on the seed " << seed;
                continue;
            }
            first = items;
            sort_answers(at.data(), n, items.data(), {}, parts);
            std::vector<Pair> pairs;
            for (std::uint32_t query = 0; query < n; ++query)
                for (std::uint64_t i = at[query * parts]; i < at[(query + 1) * parts]; ++i)
                    pairs.push_back({query, items[i]});
            ASSERT_EQ(pairs, wanted) << "level " << level;
            std::uint64_t n_found = 0;
            std::vector<Pair> capped(wanted.size() / 2);
            find_in_regions<Pass::capped>(made.view, level, regions.data(), n,
                                          {&n_found, capped.data(), capped.size()}, {});
            EXPECT_EQ(n_found, wanted.size());
            std::ranges::sort(capped);
            EXPECT_TRUE(std::ranges::includes(wanted, capped));
        }
    }
}

TEST(PackedRegionsOnDevice, AreThoseOfTheCpu) {
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        const auto layout =
            find_layout("binary").make(make_builder("median")(family.boxes, serial()), serial());
        const QueriesOfRegions all = queries_for(family.boxes);
        const QueriesOfRegions q{some(all.points), some(all.boxes), some(all.balls)};
        std::vector<Pair> in_points, in_boxes, in_balls;
        AppendPairs to_points(in_points), to_boxes(in_boxes), to_balls(in_balls);
        layout->points(q.points, serial(), to_points);
        layout->regions(q.boxes, serial(), to_boxes);
        layout->regions(q.balls, serial(), to_balls);
        const std::uint64_t seeds = family.boxes.size() > 20 ? 2 : fibre_seeds;
        expect_found(family, q.points, in_points, 1);
        expect_found(family, q.boxes, in_boxes, seeds);
        expect_found(family, q.balls, in_balls, 1);
    }
}

TEST(PackedRegionsOnDevice, PartsAreEnoughForTheWarps) {
    const PackedView large = packed_levels(1'000'000); // 62500, 3907, 245, 16, 1
    EXPECT_EQ(level_of_parts(large, 1), 1u);
    EXPECT_EQ(level_of_parts(large, 10), 2u);
    EXPECT_EQ(level_of_parts(large, 100), 3u);
    EXPECT_EQ(level_of_parts(large, 5000), 4u);
    EXPECT_EQ(level_of_parts(packed_levels(10), 1), 0u);
    EXPECT_EQ(level_of_parts(packed_levels(0), 1), 0u);
}

template <RayKernel K>
void expect_closest(const MadePackedLayout& made, const AnyLayout& layout, const TriangleMesh& mesh,
                    const std::vector<Triangle<float>>& triangles,
                    const std::vector<Ray<float>>& rays) {
    std::vector<RayHit> wanted(rays.size()), found(rays.size());
    layout.rays(rays, RayQuery::closest, K::name, layout.triangles(mesh), serial(), wanted);
    for (std::uint64_t seed = 0; seed < (mesh.triangles.size() > 100 ? 2 : fibre_seeds); ++seed) {
        on_host::set_seed(seed);
        find_closest_hits<K>({made.view, triangles.data(), rays.data(),
                              static_cast<std::uint32_t>(rays.size()), nullptr},
                             found.data(), {});
        ASSERT_EQ(found, wanted);
    }
}

TEST(PackedRaysOnDevice, AreThoseOfTheCpu) {
    std::vector<Ray<float>> rays = test_rays();
    for (std::size_t i = 0; i < 100; ++i)
        rays[i] = rays[7 * i];
    rays.resize(100);
    rays.push_back({{0, NAN, 0}, {1, 0, 0}});
    for (TriangleMesh mesh :
         {sphere(20), triangle_soup(2000), triangle_soup(17), triangle_soup(1), TriangleMesh{}}) {
        const std::size_t n = mesh.triangles.size();
        for (std::size_t i = 0; i < n; i += 2) // the same twice
            mesh.triangles.push_back(mesh.triangles[i]);
        const std::vector<Box> boxes = triangle_boxes(mesh);
        const MadePackedLayout made = made_of(boxes);
        std::vector<Triangle<float>> triangles;
        for (std::size_t slot = 0; slot < boxes.size(); ++slot)
            triangles.push_back(mesh.triangle(made.view.items[slot]));
        const auto layout =
            find_layout("binary").make(make_builder("median")(boxes, serial()), serial());
        expect_closest<Watertight>(made, *layout, mesh, triangles, rays);
        expect_closest<MollerTrumbore<double>>(made, *layout, mesh, triangles, rays);
    }
}

} // namespace
} // namespace boxwood::cuda
