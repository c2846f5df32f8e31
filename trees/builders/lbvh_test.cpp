#include "trees/builders/lbvh.h"

#include "kernels/testing/every_target.h"
#include "trees/inspect/quality.h"
#include "trees/inspect/validate.h"
#include "trees/testing/box_families.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/same_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace boxwood {
namespace {

Tree lbvh(Boxes boxes, Curve curve = LbvhBuilder{}.curve, const Executor& executor = serial()) {
    LbvhBuilder builder;
    builder.curve = curve;
    return builder.build(boxes, executor);
}

TEST(LbvhBuilder, SplitsCornersOfACubeByTheFirstBit) {
    // Morton order: x is the first bit, then y, then z. Items are numbered the other way round.
    std::vector<Box> boxes;
    for (int i = 7; i >= 0; --i) {
        const Vec3<float> p{i & 4 ? 1.f : 0.f, i & 2 ? 1.f : 0.f, i & 1 ? 1.f : 0.f};
        boxes.push_back({p, p});
    }
    const Tree tree = lbvh(boxes, Curve::morton);
    EXPECT_FALSE(validate(tree, boxes));
    for (std::uint32_t slot = 0; slot < 8; ++slot)
        EXPECT_EQ(tree.order[slot], 7 - slot);
    EXPECT_EQ(tree.nodes[Tree::left(0)].box.max.x, 0);
    EXPECT_EQ(tree.nodes[tree.right(0)].box.min.x, 1);
    for (const std::size_t half : {Tree::left(0), tree.right(0)}) {
        EXPECT_EQ(tree.nodes[half].count, 4u);
        EXPECT_EQ(tree.nodes[Tree::left(half)].box.max.y, 0);
        EXPECT_EQ(tree.nodes[tree.right(half)].box.min.y, 1);
    }
}

TEST(LbvhBuilder, IsTheTreeThatTheCodesSplit) {
    // Every node of more than one code holds those that share its leading bits, and is split at
    // the first bit in which they differ.
    std::vector<Box> boxes = random_boxes(20000, .01f, 3);
    for (std::size_t i = 0; i < boxes.size(); i += 2)
        boxes[i] = boxes[i % 64]; // many equal codes: by all of 63 bits
    for (const Curve curve : {Curve::morton, Curve::hilbert}) {
        const CurveOrder sorted = curve_order(boxes, curve, serial());
        const Tree tree = lbvh(boxes, curve);
        ASSERT_FALSE(validate(tree, boxes));
        ASSERT_TRUE(std::ranges::equal(tree.order, sorted.order));
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            if (tree.is_leaf(i))
                continue;
            const std::uint32_t first = tree.nodes[i].first,
                                middle = first + tree.nodes[i + 1].count;
            const std::uint32_t last = first + tree.nodes[i].count - 1;
            const auto code = [&](std::uint32_t slot) { return sorted.codes[slot]; };
            if (code(first) == code(last))
                continue;
            const int all = std::countl_zero(code(first) ^ code(last));
            EXPECT_EQ(std::countl_zero(code(middle - 1) ^ code(middle)), all) << i;
        }
    }
}

TEST(LbvhBuilder, IsTheSameOnEveryExecutorAndInstructionSet) {
    for (const bool equal_codes : {false, true}) {
        std::vector<Box> boxes = random_boxes(50000, .02f, 4);
        if (equal_codes)
            std::fill(boxes.begin() + 10000, boxes.end(), boxes[0]);
        const Tree expected = lbvh(boxes);
        ASSERT_FALSE(validate(expected, boxes));
        for (const auto& [name, executor] : every_executor())
            EXPECT_TRUE(same_tree(lbvh(boxes, Curve::morton, *executor), expected)) << name;
        on_every_target([&] { EXPECT_TRUE(same_tree(lbvh(boxes), expected)); });
    }
}

TEST(LbvhBuilder, DepthIsBoundedByBits) {
    std::vector<Box> identical(100000, Box{{0, 0, 0}, {1, 1, 1}}), geometric;
    for (int i = 0; i < 20000; ++i) {
        const float x = std::exp2(static_cast<float>(-(i % 125)));
        geometric.push_back({{x, x, x}, {x, x, x}});
    }
    EXPECT_LE(quality(lbvh(identical), identical, {1, 1, 0}).depth_max, 17u);
    const Tree tree = lbvh(geometric);
    EXPECT_FALSE(validate(tree, geometric));
    EXPECT_LE(quality(tree, geometric, {1, 1, 0}).depth_max, 93u);
}

TEST(LbvhBuilder, HandsOutTheOrderOfTheTree) {
    for (const BoxFamily& family : box_families())
        EXPECT_TRUE(std::ranges::equal(LbvhBuilder{}.order(family.boxes, serial()),
                                       lbvh(family.boxes).order))
            << family.name;
    EXPECT_THROW(LbvhBuilder{}.order(std::vector<Box>{Box{}}, serial()), InvalidBox);
}

} // namespace
} // namespace boxwood
