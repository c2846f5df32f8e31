#include "bench/grading/grade.h"

#include "bench/io/bad_input.h"
#include "scenes/scene.h"
#include "trees/builder.h"
#include "trees/inspect/quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;
using Row = NodeTable::Row;
using Rows = std::vector<Row>;

const Box left_box{{0, 0, 0}, {1, 1, 1}}, right_box{{3, 0, 0}, {4, 1, 1}},
    whole{{0, 0, 0}, {4, 1, 1}};

TEST(Grade, OfATreeByHand) {
    const NodeTable tree(Rows{{7, -1, -1, whole}, {-1, 7, 0, left_box}, {-1, 7, 1, right_box}});
    EXPECT_FALSE(fault_of(tree));
    const Grade g = grade(tree);
    EXPECT_EQ(g.n_nodes, 1u);
    EXPECT_EQ(g.items_per_leaf, 2);
    EXPECT_EQ(g.sah(), 2); // both items are tested by whatever meets the root
    EXPECT_EQ(g.epo, 0);
    EXPECT_EQ(g.pairs.visits, 1);
    EXPECT_EQ(g.pairs.tests, 3);
}

TEST(Grade, GetsNoBetterByALooseRoot) {
    const Box loose{{-1000, -1000, -1000}, {1000, 1000, 1000}};
    const auto of_root = [](const Box& root) {
        return grade(NodeTable(Rows{{0, -1, -1, root},
                                    {1, 0, -1, left_box},
                                    {2, 0, -1, right_box},
                                    {-1, 1, 0, left_box},
                                    {-1, 2, 1, right_box}}));
    };
    const Grade tight = of_root(whole), slack = of_root(loose);
    EXPECT_GT(slack.sah(), tight.sah());
    EXPECT_EQ(slack.points.tests, tight.points.tests);
    EXPECT_EQ(slack.rays.tests, tight.rays.tests);
}

TEST(Grade, OfOursIsThatOfInspect) {
    const Scene scene = make_scene({.generator = "clusters", .n = 500, .overlaps = 10});
    for (const BuilderEntry& builder : builders()) {
        const Tree tree = make_builder(builder.name)(scene.boxes, serial());
        const Quality known = quality(tree, scene.boxes);
        const NodeTable table(tree, scene.boxes);
        EXPECT_FALSE(fault_of(table)) << builder.name;
        const Grade g = grade(table);
        EXPECT_NEAR(g.sah(), known.sah_cost, 1e-9 * known.sah_cost) << builder.name;
        EXPECT_NEAR(g.epo, known.epo, 1e-6 * known.epo + 1e-12) << builder.name;
        EXPECT_EQ(g.depth, known.depth_max) << builder.name;
    }
}

TEST(Grade, RowsComeInAnyOrder) {
    const Scene scene = make_scene({.generator = "uniform", .n = 40, .overlaps = 3});
    const Tree tree = make_builder("median")(scene.boxes, serial());
    const NodeTable ours(tree, scene.boxes);
    Rows rows;
    std::vector<std::int64_t> parent(ours.nodes().size(), -1);
    for (std::size_t i = 0; i < ours.nodes().size(); ++i) {
        for (const std::uint32_t child : ours.children(ours.nodes()[i]))
            parent[child] = static_cast<std::int64_t>(i);
        rows.push_back({static_cast<std::int64_t>(i), parent[i], -1, ours.nodes()[i].box});
        for (const std::uint32_t item : ours.items(ours.nodes()[i]))
            rows.push_back({-1, static_cast<std::int64_t>(i), item, scene.boxes[item]});
    }
    std::ranges::reverse(rows);
    const Grade a = grade(ours), b = grade(NodeTable(rows));
    EXPECT_DOUBLE_EQ(a.sah(), b.sah());
    EXPECT_EQ(a.rays.tests, b.rays.tests);
    EXPECT_EQ(a.points.visits, b.points.visits);
}

TEST(Grade, FaultsAreNamed) {
    const NodeTable small(Rows{{0, -1, -1, left_box}, {-1, 0, 0, right_box}});
    EXPECT_EQ(fault_of(small), "node 0 does not hold item 0");
    const NodeTable hollow(Rows{{0, -1, -1, whole}, {1, 0, -1, left_box}, {-1, 0, 0, right_box}});
    EXPECT_EQ(fault_of(hollow), "node 1 has neither children nor items");
}

TEST(Grade, FaultsAreThoseOfTheNumbersThatWereGiven) {
    Rows rows{{0, -1, -1, left_box}, {-1, 0, 0, left_box}};
    rows[0].given.max.x = 1.00000001;
    rows[1].given.max.x = 1.00000002;
    EXPECT_EQ(fault_of(NodeTable(rows)), "node 0 does not hold item 0");
    rows[0].given.max.x = 1.00000002;
    EXPECT_FALSE(fault_of(NodeTable(rows)));
}

TEST(Grade, WhatIsNoTreeIsRefused) {
    const auto refusal = [](const Rows& rows) {
        try {
            NodeTable table(rows);
        } catch (const BadInput& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    const Row root{0, -1, -1, whole}, item{-1, 0, 0, left_box};
    EXPECT_EQ(refusal({root, item}), "none");
    EXPECT_THAT(refusal({item}), HasSubstr("no node is the root"));
    EXPECT_THAT(refusal({root, root, item}), HasSubstr("node 0 has two rows"));
    EXPECT_THAT(refusal({root, {1, -1, -1, whole}, item}), HasSubstr("both have no parent"));
    EXPECT_THAT(refusal({root, item, {1, 9, -1, whole}}),
                HasSubstr("no node 9, the parent of node 1 (row 0)"));
    EXPECT_THAT(refusal({root, item, {1, 2, -1, whole}, {2, 1, -1, whole}}),
                HasSubstr("in a circle"));
    EXPECT_THAT(refusal({root, item, item}), HasSubstr("item 0 has two rows"));
    EXPECT_THAT(refusal({root, item, {-1, 0, 5, whole}}), HasSubstr("is none of the 2"));
    EXPECT_THAT(refusal({root, item, {-1, -1, 1, whole}}), HasSubstr("is below no node"));
    EXPECT_THAT(refusal({root, item, {1, 0, -1, whole, 7}, {1, 0, -1, whole, 9}}),
                HasSubstr("node 1 has two rows, rows 7 and 9"));
}

} // namespace
} // namespace boxwood::bench
