#include "trees/builders/ploc.h"

#include "kernels/testing/every_target.h"
#include "trees/builders/detail/ploc_tile.h"
#include "trees/builders/lbvh.h"
#include "trees/inspect/quality.h"
#include "trees/inspect/validate.h"
#include "trees/testing/box_families.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/same_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <memory>

namespace boxwood {
using namespace detail;
namespace {

Tree ploc(Boxes boxes, int radius = PlocBuilder{}.radius, const Executor& executor = serial()) {
    PlocBuilder builder;
    builder.radius = radius;
    return builder.build(boxes, executor);
}

Quality quality_of(const Tree& tree, Boxes boxes) { return quality(tree, boxes, {1, 1, 0}); }

/// One round by two plain loops: each cluster's nearest by area and place, then those that choose
/// each other.
std::vector<PlocCluster> round_by_loops(const std::vector<PlocCluster>& clusters,
                                        std::size_t radius) {
    const std::size_t n = clusters.size();
    const auto key = [&](std::size_t i, std::size_t j) {
        const Box box = merge(clusters[i].box, clusters[j].box);
        const Vec3<float> d = box.max - box.min;
        const float area = d.x * d.y + (d.x + d.y) * d.z;
        return std::pair(std::bit_cast<std::uint32_t>(area) >> 6, (i ^ j) & 63);
    };
    std::vector<std::size_t> nearest(n);
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t best = n;
        for (std::size_t j = i < radius ? 0 : i - radius; j < std::min(n, i + radius + 1); ++j)
            if (j != i && (best == n || key(i, j) < key(i, best)))
                best = j;
        nearest[i] = best;
    }
    std::vector<PlocCluster> merged;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = nearest[i];
        if (nearest[j] != i)
            merged.push_back(clusters[i]);
        else if (i < j)
            merged.push_back({merge(clusters[i].box, clusters[j].box), 0,
                              clusters[i].count + clusters[j].count});
    }
    return merged;
}

TEST(PlocTile, MergesMutualNearestAsTwoLoopsDo) {
    const auto tile = std::make_unique<PlocTile>();
    std::vector<PlocMerge> merges(PlocTile::capacity);
    for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
        hwy::SetSupportedTargetsForTest(targets & -targets);
        for (const std::size_t n : {2u, 3u, 15u, 16u, 17u, 127u, 129u, 1000u, 2048u})
            for (const std::size_t radius : {1u, 2u, 8u, 31u}) {
                const std::vector<Box> boxes = random_boxes(n, .3f, 12);
                std::vector<PlocCluster> clusters;
                tile->clear();
                for (std::size_t i = 0; i < n; ++i) {
                    clusters.push_back({boxes[i], static_cast<std::uint32_t>(i), 1});
                    tile->add(clusters.back());
                }
                const std::vector<PlocCluster> expected = round_by_loops(clusters, radius);
                const std::size_t made =
                    tile->reduce(n - 1, radius, static_cast<std::uint32_t>(n), merges.data());
                EXPECT_EQ(made, n - expected.size());
                ASSERT_EQ(tile->size(), expected.size()) << n << " radius " << radius;
                for (std::size_t i = 0; i < expected.size(); ++i) {
                    EXPECT_EQ((*tile)[i].box, expected[i].box);
                    EXPECT_EQ((*tile)[i].count, expected[i].count);
                }
            }
    }
    hwy::SetSupportedTargetsForTest(0);
}

TEST(PlocBuilder, CostsLessThanLbvhAndLessWithALargerRadius) {
    const std::vector<Box> boxes = random_boxes(20000, .24f, 5);
    const double lbvh = quality_of(LbvhBuilder{}.build(boxes, serial()), boxes).sah_cost;
    const double one = quality_of(ploc(boxes, 1), boxes).sah_cost;
    const double usual = quality_of(ploc(boxes), boxes).sah_cost;
    EXPECT_LT(usual, .92 * lbvh);
    EXPECT_LT(usual, .95 * one);
}

TEST(PlocBuilder, IsTheSameOnEveryExecutorAndInstructionSet) {
    const std::vector<Box> boxes = random_boxes(30000, .02f, 6);
    const Tree expected = ploc(boxes);
    ASSERT_FALSE(validate(expected, boxes));
    for (const auto& [name, executor] : every_executor())
        EXPECT_TRUE(same_tree(ploc(boxes, 8, *executor), expected)) << name;
    on_every_target([&] { EXPECT_TRUE(same_tree(ploc(boxes), expected)); });
}

TEST(PlocBuilder, DepthIsBoundedOnIdenticalAndNestedBoxes) {
    std::vector<Box> identical(20000, Box{{0, 0, 0}, {1, 1, 1}}), nested, nested_fast;
    for (int i = 0; i < 20000; ++i) {
        const float r = static_cast<float>(i), f = std::exp2(static_cast<float>(i % 200 - 100));
        nested.push_back({{-r, -r, -r}, {r, r, r}});
        nested_fast.push_back({{-f, -f, -f}, {f, f, f}});
    }
    EXPECT_LE(quality_of(ploc(identical), identical).depth_max, 20u);
    for (const auto& boxes : {nested, nested_fast}) {
        const Tree tree = ploc(boxes);
        EXPECT_FALSE(validate(tree, boxes));
        EXPECT_LE(quality_of(tree, boxes).depth_max, 11u * std::bit_width(boxes.size()) + 64);
    }
}

TEST(PlocBuilder, ScalesWithTheCoordinates) {
    // Powers of two change no shape, however huge or tiny.
    const std::vector<Box> boxes = random_boxes(3000, .05f, 7);
    const Tree expected = ploc(boxes);
    for (const float scale : {0x1p100f, 0x1p-60f}) {
        std::vector<Box> scaled = boxes;
        for (Box& box : scaled)
            box = {box.min * scale, box.max * scale};
        const Tree tree = ploc(scaled);
        EXPECT_FALSE(validate(tree, scaled));
        EXPECT_TRUE(std::ranges::equal(tree.order, expected.order)) << scale;
        const double cost = quality_of(tree, scaled).sah_cost;
        EXPECT_NEAR(cost, quality_of(expected, boxes).sah_cost, 1e-6 * cost);
    }
}

} // namespace
} // namespace boxwood
