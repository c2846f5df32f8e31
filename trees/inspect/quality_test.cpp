#include "trees/inspect/quality.h"

#include "trees/builders/incremental.h"
#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace boxwood {
namespace {

Tree build(const std::vector<Box>& boxes) { return IncrementalBuilder{}.build(boxes, serial()); }

/// By definition: every node against every item outside its subtree, face by face.
double epo_by_definition(const Tree& tree, const std::vector<Box>& boxes, double c_trav,
                         double c_isect) {
    double outside = 0, surface = 0;
    for (const Box& b : boxes)
        surface += 2 * b.half_area();
    for (std::size_t i = 0; i < tree.nodes.size(); ++i)
        for (std::size_t slot = 0; slot < tree.size(); ++slot) {
            const TreeNode& node = tree.nodes[i];
            if (slot >= node.first && slot < std::size_t{node.first} + node.count)
                continue;
            const Box& item = boxes[tree.order[slot]];
            for (int axis = 0; axis < 3; ++axis)
                for (const bool upper : {false, true}) {
                    Box face = item;
                    (upper ? face.min : face.max)[axis] = (upper ? item.max : item.min)[axis];
                    const Box inside{max(face.min, node.box.min), min(face.max, node.box.max)};
                    outside += (node.count == 1 ? c_isect : c_trav) * inside.half_area();
                }
        }
    return surface > 0 ? outside / surface : 0;
}

TEST(Quality, NoneAndOne) {
    const Quality none = quality(Tree{}, {});
    EXPECT_EQ(none.n_nodes, 0u);
    EXPECT_EQ(none.sah_cost, 0);
    const std::vector<Box> one{{{0, 0, 0}, {1, 2, 3}}};
    const Quality q = quality(build(one), one, {.c_trav = 3, .c_isect = 5});
    EXPECT_EQ(q.n_nodes, 1u);
    EXPECT_EQ(q.n_leaves, 1u);
    EXPECT_EQ(q.depth_max, 0u);
    EXPECT_EQ(q.bytes, 36u);
    EXPECT_EQ(q.sah_cost, 5);
    EXPECT_EQ(q.epo, 0);
    EXPECT_EQ(q.overlap, 0);
}

/// Three boxes 1 x 1 in y and z, over [0, 2], [1, 3] and [4, 5] in x; the first two are siblings.
TEST(Quality, ByHand) {
    const std::vector<Box> boxes{
        {{0, 0, 0}, {2, 1, 1}}, {{1, 0, 0}, {3, 1, 1}}, {{4, 0, 0}, {5, 1, 1}}};
    Tree tree(3);
    const Box pair{{0, 0, 0}, {3, 1, 1}}, all{{0, 0, 0}, {5, 1, 1}};
    tree.nodes[0] = {all, 0, 3};
    tree.nodes[1] = {pair, 0, 2};
    for (std::uint32_t i = 0; i < 3; ++i) {
        tree.nodes[i + 2] = {boxes[i], i, 1};
        tree.order[i] = i;
    }
    const Quality q = quality(tree, boxes, {.c_trav = 2, .c_isect = 3});
    EXPECT_EQ(q.n_nodes, 5u);
    EXPECT_EQ(q.n_leaves, 3u);
    EXPECT_EQ(q.depth_max, 2u);
    EXPECT_DOUBLE_EQ(q.depth_mean, 5. / 3);
    EXPECT_EQ(q.leaf_mean, 1);
    EXPECT_EQ(q.bytes, 5 * 32u + 3 * 4u);
    // Half areas: all 11, pair 7, leaves 5, 5, 3.
    EXPECT_DOUBLE_EQ(q.sah_cost, 2 * (1 + 7. / 11) + 3 * (13. / 11));
    // The leaves [0, 2] and [1, 3] hold of each other one end face of area 1 and four strips of 1.
    EXPECT_DOUBLE_EQ(q.epo, 3 * (5. + 5.) / (10 + 10 + 6));
    EXPECT_EQ(q.epo_items, 3u);
    // Root: none shared. Pair: a unit cube, half area 3 of 7.
    EXPECT_DOUBLE_EQ(q.overlap, (0 + 3. / 7) / 2);
}

TEST(Quality, EpoIsItsDefinition) {
    for (const BoxFamily& family : box_families()) {
        if (family.boxes.size() > 600 || family.name == "whole space and corners")
            continue; // slow; sums of 1e77 and 1 in different orders
        const Tree tree = build(family.boxes);
        const Quality q = quality(tree, family.boxes, {.c_trav = 1.5, .c_isect = .5});
        const double want = epo_by_definition(tree, family.boxes, 1.5, .5);
        EXPECT_NEAR(q.epo, want, 1e-9 * want) << family.name;
        EXPECT_EQ(q.epo_items, family.boxes.size()) << family.name;
    }
}

TEST(Quality, EpoStaysWithinItsVisits) {
    const auto boxes = random_boxes(20000, .02f, 11);
    const Tree tree = build(boxes);
    const Quality all = quality(tree, boxes);
    const Quality some = quality(tree, boxes, {.epo_visits = 200000});
    EXPECT_EQ(all.epo_items, 20000u);
    EXPECT_GT(some.epo_items, 500u);
    EXPECT_LT(some.epo_items, 5000u);
    EXPECT_NEAR(some.epo, all.epo, .1 * all.epo);
    const Quality none = quality(tree, boxes, {.epo_visits = 0});
    EXPECT_EQ(none.epo_items, 0u);
    EXPECT_EQ(none.epo, 0);
    EXPECT_EQ(none.sah_cost, all.sah_cost);
}

TEST(Quality, FiniteOnEveryFamily) {
    for (const BoxFamily& family : box_families()) {
        const Quality q = quality(build(family.boxes), family.boxes);
        EXPECT_TRUE(std::isfinite(q.sah_cost) && std::isfinite(q.epo)) << family.name;
        EXPECT_TRUE(q.overlap >= 0 && q.overlap <= 1) << family.name;
        EXPECT_LE(q.depth_mean, static_cast<double>(q.depth_max)) << family.name;
    }
    const std::vector<Box> points(100, Box{{1, 2, 3}, {1, 2, 3}});
    const Quality q = quality(build(points), points);
    EXPECT_EQ(q.sah_cost, 199);
    EXPECT_EQ(q.overlap, 1);
    EXPECT_EQ(q.epo, 0);
}

TEST(Quality, CountsMustAgree) {
    const auto boxes = random_boxes(5, .1f, 1);
    EXPECT_THROW(quality(build(boxes), Boxes(boxes).first(4)), std::invalid_argument);
}

} // namespace
} // namespace boxwood
