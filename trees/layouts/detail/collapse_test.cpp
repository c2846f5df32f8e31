#include "trees/builder.h"
#include "trees/layouts/detail/collapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace boxwood {
using namespace detail;
namespace {

constexpr std::uint32_t width = 4;

double area_beside(const Tree& tree, std::size_t node, std::uint32_t blocks);

/// The least area of a block and all below it, by trying everything.
double area_below(const Tree& tree, std::size_t node) {
    const double own = tree.nodes[node].box.half_area();
    if (tree.nodes[node].count <= width)
        return own;
    double min_area = std::numeric_limits<double>::infinity();
    for (std::uint32_t k = 1; k < width; ++k)
        min_area = std::min(min_area, area_beside(tree, Tree::left(node), k) +
                                          area_beside(tree, tree.right(node), width - k));
    return own + min_area;
}

/// The same of a subtree that may stand as up to so many blocks side by side.
double area_beside(const Tree& tree, std::size_t node, std::uint32_t blocks) {
    double min_area = area_below(tree, node);
    if (!tree.is_leaf(node))
        for (std::uint32_t k = 1; k < blocks; ++k)
            min_area = std::min(min_area, area_beside(tree, Tree::left(node), k) +
                                              area_beside(tree, tree.right(node), blocks - k));
    return min_area;
}

std::vector<Box> scattered(std::size_t n, unsigned seed) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < n; ++i) {
        Vec3<float> at, size;
        for (int k = 0; k < 3; ++k) {
            seed = seed * 1664525 + 1013904223;
            at[k] = static_cast<float>(seed >> 8 & 1023);
            size[k] = static_cast<float>(seed >> 20 & 127);
        }
        boxes.push_back({at, at + size});
    }
    return boxes;
}

TEST(Collapse, HasTheLeastAreaOfAll) {
    for (const char* builder : {"median", "binned_sah"})
        for (unsigned seed = 0; seed < 20; ++seed) {
            const auto boxes = scattered(2 + seed, seed);
            const Tree tree = find_builder(builder).make({})(boxes, serial());
            double area = 0;
            for (const CollapsedBlock& block : collapse<width>(tree, serial()).blocks)
                area += tree.nodes[block.node].box.half_area();
            const double min_area = area_below(tree, 0);
            EXPECT_NEAR(area, min_area, 1e-4 * min_area) << builder << " seed " << seed;
        }
}

TEST(Collapse, FillsTheBlocksOfIdenticalBoxes) {
    const std::vector<Box> boxes(4096, Box{{1, 1, 1}, {1, 1, 1}});
    const Tree tree = find_builder("binned_sah").make({})(boxes, serial());
    const Collapsed collapsed = collapse<8>(tree, serial());
    EXPECT_EQ(collapsed.blocks.size(), 512u + 64 + 8 + 1);
    EXPECT_EQ(collapsed.depth, 4u);
}

TEST(Collapse, NeedsFewerBlocksOfTreesCountedInBlocks) {
    const auto boxes = scattered(20000, 1);
    const auto blocks = [&](const Settings& settings) {
        const Tree tree = find_builder("binned_sah").make(settings)(boxes, serial());
        return collapse<8>(tree, serial()).blocks.size();
    };
    EXPECT_LT(blocks({{"leaf_size", 8}, {"agglomerate_below", 8}}), blocks({}) * 9 / 10);
}

} // namespace
} // namespace boxwood
