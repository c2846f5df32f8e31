#include "trees/dynamic/detail/nearest_first.h"

#include "trees/executor.h"
#include "trees/queries/sinks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

namespace boxwood::detail {
namespace {

/// Boxes of one block, two wide, side by side along x.
struct Row {
    std::vector<Box> boxes;
    PackedLayout tree;

    explicit Row(const std::vector<float>& places) {
        for (const float x : places)
            boxes.push_back({{x - 1, -1, -1}, {x + 1, 1, 1}});
        std::vector<std::uint32_t> order(boxes.size());
        std::iota(order.begin(), order.end(), 0u);
        tree = PackedLayout::of_order(boxes, order, serial());
    }
    float place(std::uint32_t item) const { return boxes[item].min.x + 1; }
};
/// As many as a block holds, so that its last lane is one of them.
const std::vector<float> places{9,     .5f, -.25f, 3,   1.75f, -6,    0,   -1.5f,
                                11.5f, 40,  -20,   2.5, 4.75f, -8.5f, -30, .125f};
constexpr float no_limit = std::numeric_limits<float>::infinity();

TEST(NearestFirst, OverlappingBoxesComeByTheirCentres) {
    const Row row(places);
    std::vector<float> found, expected;
    const Box box{{-1, -1, -1}, {1, 1, 1}};
    EXPECT_TRUE(NearestFirst(no_limit).near_box(row.tree, box, [&](std::uint32_t i, std::uint32_t) {
        found.push_back(std::abs(row.place(i)));
        return true;
    }));
    for (const float x : places)
        expected.push_back(std::abs(x));
    std::ranges::sort(expected); // gaps are ordered as the places are
    EXPECT_EQ(found, expected);
}

TEST(NearestFirst, PairsComeByTheirGaps) {
    const Row row(places), other({.25f, -7, 2, 35, 0, 1, 5, -3, 12, 18, -11, 7, 6, -1, -2, 3.5f});
    const auto expect_order = [](const Row& a, const Row& b, std::size_t n, const auto& search) {
        std::vector<float> found;
        std::set<Pair> pairs;
        EXPECT_TRUE(search([&](std::uint32_t i, std::uint32_t j) {
            found.push_back(std::max(0.f, std::abs(a.place(i) - b.place(j)) - 2));
            pairs.insert({i, j});
            return true;
        }));
        EXPECT_EQ(pairs.size(), n);
        EXPECT_TRUE(std::ranges::is_sorted(found));
        EXPECT_GT(std::ranges::count_if(found, [](float gap) { return gap == 0; }), 10);
    };
    expect_order(row, other, 256, [&](NearestFirst::Decide decide) {
        return NearestFirst(no_limit).tree_pairs(row.tree, other.tree, decide);
    });
    expect_order(row, row, 120, [&](NearestFirst::Decide decide) {
        return NearestFirst(no_limit).self_pairs(row.tree, decide);
    });
}

} // namespace
} // namespace boxwood::detail
