#include "trees/optimizers/refit.h"

#include "trees/builders/incremental.h"
#include "trees/inspect/validate.h"
#include "trees/testing/box_families.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace boxwood {
namespace {

bool same_boxes(const Tree& a, const Tree& b) {
    return std::ranges::equal(a.nodes, b.nodes, {}, &TreeNode::box, &TreeNode::box);
}

TEST(Refit, BoundsAreExactAfterAnyMoves) {
    for (const std::uint32_t n : {0u, 1u, 2u, 3u, 1000u}) {
        Tree tree = IncrementalBuilder{}.build(random_boxes(n, .1f, 1), serial());
        const auto moved = random_boxes(n, .3f, 2);
        EXPECT_EQ(refit(tree, moved), 2 * n - (n ? 1 : 0)) << "every box differs";
        EXPECT_EQ(validate(tree, moved).value_or(""), "") << n;
        EXPECT_EQ(refit(tree, moved), 0u);
    }
}

TEST(Refit, CountsTheNodesThatChange) {
    auto boxes = random_boxes(500, .1f, 3);
    Tree tree = IncrementalBuilder{}.build(boxes, serial());
    const std::vector<TreeNode> before(tree.nodes.begin(), tree.nodes.end());
    boxes[17].max.x += 10;
    const std::size_t changed = refit(tree, boxes);
    std::size_t differ = 0, hold = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        differ += !(before[i].box == tree.nodes[i].box);
        for (std::uint32_t s = before[i].first; s < before[i].first + before[i].count; ++s)
            hold += tree.order[s] == 17;
    }
    EXPECT_EQ(changed, differ);
    EXPECT_EQ(changed, hold) << "the leaf and each of its ancestors";
}

TEST(Refit, BadInputChangesNothing) {
    auto boxes = random_boxes(20, .1f, 4);
    Tree tree = IncrementalBuilder{}.build(boxes, serial());
    const Tree untouched = IncrementalBuilder{}.build(boxes, serial());
    for (Box& box : boxes)
        box.max.x += 1;
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -100.f,
                            std::numeric_limits<float>::infinity()}) {
        auto wrong = boxes;
        wrong[9].max.z = bad;
        EXPECT_THAT([&] { refit(tree, wrong); },
                    testing::Throws<InvalidBox>(testing::Field(&InvalidBox::index, 9u)))
            << bad;
        EXPECT_TRUE(same_boxes(tree, untouched));
    }
    EXPECT_THROW(refit(tree, Boxes(boxes).first(19)), std::invalid_argument);
    EXPECT_TRUE(same_boxes(tree, untouched));
    tree.order[3] = 20;
    EXPECT_THROW(refit(tree, boxes), std::invalid_argument);
    EXPECT_TRUE(same_boxes(tree, untouched));
}

} // namespace
} // namespace boxwood
