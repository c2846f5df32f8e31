#include "trees/optimizers/reinsertion.h"

#include "trees/inspect/quality.h"
#include "trees/inspect/validate.h"
#include "trees/optimizers/refit.h"
#include "trees/testing/box_families.h"
#include "trees/testing/each_builder.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/same_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace boxwood {
namespace {

/// The sum of the areas of the inner nodes: what moves lessen.
double inner_area(const Tree& tree) {
    double sum = 0;
    for (const TreeNode& node : tree.nodes)
        sum += node.count > 1 ? node.box.half_area() : 0;
    return sum;
}

/// A chain: each left child is a leaf.
Tree chain_of(Boxes boxes) {
    Tree tree(boxes.size());
    const auto n = static_cast<std::uint32_t>(boxes.size());
    for (std::uint32_t i = 0; i < n; ++i) {
        tree.order[i] = i;
        tree.nodes[2 * i] = {{}, i, n - i};
        if (i + 1 < n)
            tree.nodes[2 * i + 1] = {{}, i, 1};
    }
    refit(tree, boxes);
    return tree;
}

TEST_P(EachBuilder, ReinsertionKeepsEveryFamilyValidAndNeverCostsMore) {
    for (const BoxFamily& family : box_families()) {
        Tree tree = build(family.boxes);
        const double before = inner_area(tree);
        ReinsertionOptimizer{}.improve(tree, serial());
        ASSERT_EQ(validate(tree, family.boxes).value_or(""), "") << family.name;
        EXPECT_LE(inner_area(tree), before * (1 + 1e-9)) << family.name;
    }
}

TEST(Reinsertion, IsReachedByItsWordWithItsSettings) {
    const std::vector<Box> boxes = random_boxes(2000, .05f, 3);
    const auto cost = [&](std::string_view name, const Settings& settings) {
        const Tree tree = make_builder(name, settings)(boxes, serial());
        EXPECT_EQ(validate(tree, boxes).value_or(""), "");
        return quality(tree, boxes).sah_cost;
    };
    const double plain = cost("median", {}), two = cost("median+reinsertion", {}),
                 one = cost("median+reinsertion", {{"passes", 1}}),
                 part = cost("median+reinsertion", {{"passes", 1}, {"share", .3}});
    EXPECT_EQ(cost("median+reinsertion", {{"passes", 0}}), plain);
    EXPECT_LT(two, .92 * plain);
    EXPECT_LT(two, one);
    EXPECT_LT(one, part);
    EXPECT_LT(part, plain);
}

TEST(Reinsertion, SameTreeForAnyNumberOfThreads) {
    const std::vector<Box> boxes = random_boxes(5000, .05f, 4);
    const Tree expected = make_builder("median+reinsertion")(boxes, serial());
    for (const auto& [name, executor] : every_executor()) {
        const Tree tree = make_builder("median+reinsertion")(boxes, *executor);
        EXPECT_TRUE(same_tree(tree, expected)) << name;
    }
}

TEST(Reinsertion, UntanglesTwoPairs) {
    // a and b lie far from c and d, but the tree joins a with c and b with d.
    const std::vector<Box> boxes{{{0, 0, 0}, {1, 1, 1}},
                                 {{0, 0, 1}, {1, 1, 2}},
                                 {{90, 0, 0}, {91, 1, 1}},
                                 {{90, 0, 1}, {91, 1, 2}}};
    Tree tree(4);
    const std::uint32_t order[]{0, 2, 1, 3}, first[]{0, 0, 0, 1, 2, 2, 3},
        count[]{4, 2, 1, 1, 2, 1, 1};
    std::ranges::copy(order, tree.order.begin());
    for (std::size_t i = 0; i < 7; ++i)
        tree.nodes[i] = {{}, first[i], count[i]};
    refit(tree, boxes);
    ASSERT_EQ(validate(tree, boxes).value_or(""), "");
    ReinsertionOptimizer{}.improve(tree, serial());
    ASSERT_EQ(validate(tree, boxes).value_or(""), "");
    const double pair_area = 1 + 2 + 2;
    EXPECT_DOUBLE_EQ(inner_area(tree), 91 + 2 + 2 * 91 + 2 * pair_area);
}

/// A tree as sets of items: the oracle, which knows nothing of links and boxes kept up to date.
struct Nested {
    std::vector<Nested> children; ///< two, or none in a leaf
    std::uint32_t item = 0;

    Box box(Boxes boxes, double& area) const {
        if (children.empty())
            return boxes[item];
        const Box b = merge(children[0].box(boxes, area), children[1].box(boxes, area));
        area += b.half_area();
        return b;
    }
};

Nested nested(const Tree& tree, std::size_t i) {
    if (tree.is_leaf(i))
        return {{}, tree.item(i)};
    return {{nested(tree, Tree::left(i)), nested(tree, tree.right(i))}, 0};
}

/// The tree without its k-th node in preorder, which is left in `taken`.
Nested without(const Nested& tree, std::size_t& k, Nested& taken) {
    for (std::size_t side = 0; side < tree.children.size(); ++side) {
        if (--k == 0) {
            taken = tree.children[side];
            return tree.children[1 - side];
        }
        const bool before = k != 0;
        Nested changed = without(tree.children[side], k, taken);
        if (before && k == 0) {
            Nested result = tree;
            result.children[side] = changed;
            return result;
        }
    }
    return tree;
}

Nested with(const Nested& tree, std::size_t& k, const Nested& added) {
    if (k-- == 0)
        return {{tree, added}, 0};
    Nested result = tree;
    for (Nested& child : result.children)
        if (k != ~std::size_t{0})
            child = with(child, k, added);
    return result;
}

TEST(Reinsertion, EndsWhereNoSingleMoveHelps) {
    for (std::uint32_t seed = 0; seed < 30; ++seed) {
        const std::uint32_t n = 3 + seed % 9;
        const std::vector<Box> boxes = random_boxes(n, .3f, 100 + seed);
        Tree tree = seed % 2 ? chain_of(boxes) : make_builder("median")(boxes, serial());
        ReinsertionOptimizer optimizer;
        optimizer.passes = 100;
        optimizer.improve(tree, serial());
        ASSERT_EQ(validate(tree, boxes).value_or(""), "");
        const Nested reached = nested(tree, 0);
        double area = 0;
        reached.box(boxes, area);
        EXPECT_NEAR(area, inner_area(tree), 1e-9 * area);
        for (std::size_t node = 1; node < 2 * n - 1; ++node) {
            Nested taken;
            std::size_t k = node;
            const Nested rest = without(reached, k, taken);
            std::size_t in_taken = 0;
            const std::function<void(const Nested&)> tally = [&](const Nested& t) {
                ++in_taken;
                std::ranges::for_each(t.children, tally);
            };
            tally(taken);
            for (std::size_t place = 0; place < 2 * n - 2 - in_taken; ++place) {
                std::size_t p = place;
                double other = 0;
                with(rest, p, taken).box(boxes, other);
                EXPECT_GE(other, area * (1 - 1e-5)) << seed << ": " << node << " to " << place;
            }
        }
    }
}

TEST(Reinsertion, TakesLittleTimeOnAChain) {
    // Without limits each search climbs the whole chain: 10^9 steps.
    const std::vector<Box> boxes = random_boxes(30000, .01f, 5);
    Tree tree = chain_of(boxes);
    const double before = inner_area(tree);
    ReinsertionOptimizer optimizer;
    optimizer.passes = 1;
    optimizer.improve(tree, serial());
    EXPECT_FALSE(validate(tree, boxes));
    EXPECT_LT(inner_area(tree), .5 * before);
}

TEST(Reinsertion, KeepsTheLeavesOfASplitTree) {
    const std::vector<Box> boxes = random_boxes(500, .3f, 6);
    Tree tree = make_builder("median")(boxes, serial());
    tree.is_split = true;
    for (std::uint32_t& item : tree.order)
        item /= 2;
    const auto leaves = [](const Tree& t) {
        std::vector<std::pair<std::uint32_t, float>> all;
        for (std::size_t i = 0; i < t.nodes.size(); ++i)
            if (t.is_leaf(i))
                all.emplace_back(t.item(i), t.nodes[i].box.min.x);
        std::ranges::sort(all);
        return all;
    };
    const auto before = leaves(tree);
    ReinsertionOptimizer{}.improve(tree, serial());
    EXPECT_TRUE(tree.is_split);
    EXPECT_EQ(leaves(tree), before);
}

} // namespace
} // namespace boxwood
