#include "trees/inspect/draw.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace boxwood {
namespace {

Box unit_at(float x) { return {{x, 0, 0}, {x + 1, 1, 1}}; }

/// ((2, 0), 1), made by hand.
Tree three() {
    Tree tree(3);
    tree.order[0] = 2;
    tree.order[1] = 0;
    tree.order[2] = 1;
    tree.nodes[0] = {{{0, 0, 0}, {9.5f, 1, 1}}, 0, 3};
    tree.nodes[1] = {{{0, 0, 0}, {3, 1, 1}}, 0, 2};
    tree.nodes[2] = {unit_at(0), 0, 1};
    tree.nodes[3] = {unit_at(2), 1, 1};
    tree.nodes[4] = {unit_at(8.5f), 2, 1};
    return tree;
}

TEST(Draw, NamesBoxesAndBranches) {
    const std::vector<std::string> names{"ant", "bee", "cat"};
    EXPECT_EQ(draw(three(), names), "{cat, ant, bee}  x [0, 9.5]  y [0, 1]  z [0, 1]\n"
                                    "├── {cat, ant}   x [0, 3]  y [0, 1]  z [0, 1]\n"
                                    "│   ├── cat      x [0, 1]  y [0, 1]  z [0, 1]\n"
                                    "│   └── ant      x [2, 3]  y [0, 1]  z [0, 1]\n"
                                    "└── bee          x [8.5, 9.5]  y [0, 1]  z [0, 1]\n");
}

TEST(Draw, WithoutNamesItemsAreNumbers) {
    const std::string text = draw(three());
    EXPECT_NE(text.find("{2, 0, 1}"), std::string::npos) << text;
    EXPECT_NE(text.find("└── 1 "), std::string::npos) << text;
}

TEST(Draw, EmptyAndSingle) {
    EXPECT_EQ(draw(Tree{}), "(empty tree)\n");
    Tree one(1);
    one.order[0] = 0;
    one.nodes[0] = {unit_at(0), 0, 1};
    EXPECT_EQ(draw(one), "0  x [0, 1]  y [0, 1]  z [0, 1]\n");
}

TEST(Draw, CoordinatesAreRoundedToTheSizeOfTheWhole) {
    Tree one(1);
    one.order[0] = 0;
    one.nodes[0] = {{{-1e-9f, 0.123456f, -2e-8f}, {1e-15f, 1.99996f, 7}}, 0, 1};
    EXPECT_EQ(draw(one), "0  x [0, 0]  y [0.123, 2]  z [0, 7]\n");
    one.nodes[0].box = {{-1e36f, -12, 1e-30f}, {3e38f, 12, 1}};
    EXPECT_EQ(draw(one), "0  x [-1e+36, 3e+38]  y [0, 0]  z [0, 0]\n");
}

TEST(Draw, RefusesAWrongNumberOfNames) {
    const std::vector<std::string> names{"ant", "bee"};
    EXPECT_THROW(draw(three(), names), std::invalid_argument);
}

TEST(Draw, ALargeNodeSaysHowManyItems) {
    Tree tree(9);
    tree.nodes[0] = {unit_at(0), 0, 9};
    EXPECT_EQ(describe(tree, 0), "{9 items}");
}

} // namespace
} // namespace boxwood
