#include "trees/testing/append_hits.h"
#include "trees/testing/box_families.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/layouts_answering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

/// One query with as many answers as there are items: complete, however many.
namespace boxwood {
namespace {

constexpr std::uint32_t many = 100'000;

std::vector<ExecutorToTry> one_thread_and_two() {
    std::vector<ExecutorToTry> both;
    both.push_back({"serial", make_executor("serial", 1)});
    both.push_back({"tbb on 2", make_executor("tbb", 2)});
    return both;
}

/// Triangles at z = 0, 1, ... about the z axis: in the box of each of them, and hit by a ray
/// along it.
TriangleMesh stack_of_triangles() {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < many; ++i) {
        const auto z = static_cast<float>(i);
        mesh.vertices.insert(mesh.vertices.end(), {{-1, -1, z}, {2, -1, z}, {-1, 2, z}});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

void expect_each_once(std::vector<Pair> pairs, const std::string& query) {
    ASSERT_EQ(pairs.size(), 2 * many) << query;
    for (std::uint32_t i = 0; i < 2 * many; ++i)
        ASSERT_EQ(pairs[i], (Pair{i / many, i % many})) << query;
}

TEST(Truncation, OneQueryWithAHundredThousandAnswersIsComplete) {
    const std::vector<Box> boxes(many, Box{{0, 0, 0}, {1, 1, 1}});
    const std::vector<Vec3<float>> points(2, Vec3<float>{1, .5f, 0});
    const std::vector<Box> regions(2, Box{{1, 1, 1}, {2, 2, 2}});
    const std::vector<Sphere<float>> balls(2, Sphere<float>{{2, .5f, .5f}, 1});
    const Tree tree = make_builder("lbvh")(boxes, serial());
    for (const ExecutorToTry& executor : one_thread_and_two())
        for (const LayoutEntry& entry :
             layouts_answering({Query::points, Query::regions, Query::nearest})) {
            SCOPED_TRACE(std::string(entry.name) + ", " + executor.name);
            const auto layout = entry.make(tree, serial());
            std::vector<Pair> pairs;
            AppendPairs sink(pairs);
            layout->points(points, *executor.run, sink);
            expect_each_once(std::exchange(pairs, {}), "points");
            layout->regions(regions, *executor.run, sink);
            expect_each_once(std::exchange(pairs, {}), "boxes");
            layout->regions(balls, *executor.run, sink);
            expect_each_once(std::exchange(pairs, {}), "spheres");
            std::vector<Neighbour> near(many + 3);
            layout->nearest({points.data(), 1}, many + 3, *executor.run, near);
            for (std::uint32_t i = 0; i < many + 3; ++i)
                ASSERT_EQ(near[i], i < many ? (Neighbour{i, 0}) : Neighbour{}) << i;
        }
}

TEST(Truncation, OneRayThroughAHundredThousandTrianglesHitsEach) {
    const TriangleMesh mesh = stack_of_triangles();
    std::vector<Box> boxes;
    for (std::uint32_t i = 0; i < many; ++i)
        boxes.push_back(mesh.triangle(i).bounds());
    const std::vector<Ray<float>> rays(2, Ray<float>{{0, 0, -1}, {0, 0, 1}});
    const Tree tree = make_builder("lbvh")(boxes, serial());
    for (const ExecutorToTry& executor : one_thread_and_two())
        for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
            SCOPED_TRACE(std::string(entry.name) + ", " + executor.name);
            const auto layout = entry.make(tree, serial());
            AppendHits hits;
            layout->rays_all(rays, "exact", layout->triangles(mesh), *executor.run, hits);
            ASSERT_EQ(hits.all.size(), 2 * many);
            for (std::uint32_t i = 0; i < 2 * many; ++i) {
                ASSERT_EQ(hits.all[i].first, i / many);
                ASSERT_EQ(hits.all[i].second.triangle, i % many);
            }
        }
}

/// 1,000 identical boxes: half a million pairs, and a million of one tree with another.
TEST(Truncation, AllPairsOfIdenticalBoxesAreThere) {
    constexpr std::uint64_t m = 1000;
    const std::vector<Box> boxes(m, Box{{0, 0, 0}, {1, 1, 1}});
    for (const ExecutorToTry& executor : one_thread_and_two())
        for (const LayoutEntry& entry : layouts_answering({Query::self_pairs})) {
            SCOPED_TRACE(std::string(entry.name) + ", " + executor.name);
            Tree tree;
            const auto layout =
                make_layout(entry, make_builder("hilbert"), boxes, *executor.run, tree);
            std::vector<Pair> pairs;
            AppendPairs sink(pairs);
            layout->self_pairs(*executor.run, sink);
            std::ranges::sort(pairs);
            EXPECT_EQ(pairs.size(), m * (m - 1) / 2);
            EXPECT_EQ(std::ranges::adjacent_find(pairs), pairs.end());
            if (!layout->answers(Query::tree_pairs))
                continue;
            CountPairs count;
            layout->tree_pairs(*layout, *executor.run, count);
            EXPECT_EQ(count.count(), m * m);
        }
}

} // namespace
} // namespace boxwood
