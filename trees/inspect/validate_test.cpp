#include "trees/inspect/validate.h"

#include <gmock/gmock.h>

#include <utility>
#include <vector>

namespace boxwood {
namespace {

using testing::HasSubstr;

/// A tree of unit cubes at x = 0, 2, 4, ...: each inner node puts one item left and the rest right,
/// the deepest shape there is; or the mirror image of it.
struct Chain {
    std::vector<Box> boxes;
    Tree tree;

    explicit Chain(std::uint32_t n, bool mirrored = false) : tree(n) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const float x = 2 * static_cast<float>(i);
            boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
            tree.order[i] = i;
        }
        const float end = 2 * static_cast<float>(n) - 1;
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            const std::uint32_t inner = mirrored ? i : 2 * i, count = n - i;
            const std::uint32_t leaf = mirrored ? 2 * n - 2 - i : 2 * i + 1;
            const std::uint32_t slot = mirrored ? n - 1 - i : i;
            const float low = mirrored ? 0 : boxes[i].min.x;
            const float high = mirrored ? boxes[n - 1 - i].max.x : end;
            tree.nodes[inner] = {{{low, 0, 0}, {high, 1, 1}}, mirrored ? 0 : i, count};
            tree.nodes[leaf] = {boxes[slot], slot, 1};
        }
        if (n > 0) {
            const std::uint32_t last = mirrored ? n - 1 : 2 * n - 2, slot = mirrored ? 0 : n - 1;
            tree.nodes[last] = {boxes[slot], slot, 1};
        }
    }
    std::string fault(Bounds bounds = Bounds::tight) const {
        return validate(tree, boxes, bounds).value_or("");
    }
};

TEST(Validate, WellFormed) {
    for (const std::uint32_t n : {0u, 1u, 2u, 3u, 10u})
        for (const bool mirrored : {false, true}) {
            EXPECT_EQ(Chain(n, mirrored).fault(), "") << n;
            EXPECT_EQ(Chain(n, mirrored).fault(Bounds::containing), "") << n;
        }
}

TEST(Validate, DepthIsNoLimit) {
    EXPECT_EQ(Chain(200000).fault(), "");
    EXPECT_EQ(Chain(200000, true).fault(), "");
}

TEST(Validate, NumberOfItemsAndNodes) {
    Chain chain(5);
    chain.boxes.pop_back();
    EXPECT_THAT(chain.fault(), HasSubstr("holds 5 items, but there are 4 boxes"));
    chain = Chain(5);
    chain.tree.nodes.shrink(8);
    EXPECT_THAT(chain.fault(), HasSubstr("8 nodes, but 5 items need 9"));
    chain = Chain(0);
    chain.tree.nodes = Buffer<TreeNode>(1);
    EXPECT_THAT(chain.fault(), HasSubstr("1 nodes, but 0 items need 0"));
}

TEST(Validate, EachItemInOneSlot) {
    Chain chain(5);
    chain.tree.order[3] = 1;
    EXPECT_THAT(chain.fault(), HasSubstr("slot 3: item 1 is in slot 1 already"));
    chain.tree.order[3] = 5;
    EXPECT_THAT(chain.fault(), HasSubstr("slot 3: item 5 of a tree of 5 items"));
}

TEST(Validate, ShapeFollowsTheArithmetic) {
    for (const std::uint32_t wrong : {0u, 1u, 2u, 4u, 5u, 6u, ~0u}) {
        Chain chain(5);
        chain.tree.nodes[2].count = wrong;
        if (wrong != 4) {
            EXPECT_THAT(chain.fault(), HasSubstr("node 2: ")) << wrong;
        }
        chain = Chain(5, true);
        chain.tree.nodes[1].count = wrong;
        if (wrong == 1 || wrong == 2) { // a possible left child; then the nodes after it are wrong
            EXPECT_THAT(chain.fault(), HasSubstr("node ")) << wrong;
        } else if (wrong != 4) {
            EXPECT_THAT(chain.fault(), HasSubstr("node 1: count ")) << wrong;
        }
    }
    Chain chain(5);
    chain.tree.nodes[4].first = 3;
    EXPECT_THAT(chain.fault(), HasSubstr("node 4: first 3, count 3"));
    chain = Chain(5);
    chain.tree.nodes[0].count = 4;
    EXPECT_THAT(chain.fault(), HasSubstr("node 0: "));
    chain = Chain(1);
    chain.tree.nodes[0].count = 0;
    EXPECT_THAT(chain.fault(), HasSubstr("node 0: "));
}

TEST(Validate, LeafBoxIsItsItemsBox) {
    Chain chain(5);
    std::swap(chain.tree.order[1], chain.tree.order[2]);
    EXPECT_THAT(chain.fault(), HasSubstr("node 3: its box is not exactly the box of its item 2"));
    EXPECT_THAT(chain.fault(Bounds::containing), HasSubstr("node 3: its box does not hold"));
}

TEST(Validate, InnerBoxIsTheUnion) {
    Chain fat(5);
    fat.tree.nodes[4].box.max.y = 1.5f;
    EXPECT_THAT(fat.fault(), HasSubstr("node 2: its box is not exactly the union of its children, "
                                       "nodes 3 and 4"));
    fat.tree.nodes[2].box.max.y = fat.tree.nodes[0].box.max.y = 2;
    EXPECT_THAT(fat.fault(), HasSubstr("node 2"));
    EXPECT_EQ(fat.fault(Bounds::containing), "");
    Chain thin(5);
    thin.tree.nodes[0].box.max.x -= .5f;
    EXPECT_THAT(thin.fault(Bounds::containing), HasSubstr("node 0: its box does not hold"));
    Chain nan(5);
    nan.tree.nodes[2].box.min.z = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(nan.fault(), "");
    EXPECT_THAT(nan.fault(Bounds::containing), HasSubstr("node 2"));
}

} // namespace
} // namespace boxwood
