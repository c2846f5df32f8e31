/// Updater::sah against the blocks of the tree, and against lines that are shot through them.

#include "trees/dynamic/detail/policy.h"
#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <vector>

namespace boxwood {
using namespace detail;
namespace {

const MovingTree* seen_tree = nullptr;

/// Keeps its first order, and shows its tree.
struct Shown {
    static constexpr std::string_view name = "shown", summary = "for the test";
    static std::array<Setting<Shown>, 0> settings() { return {}; }
    void start(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.reorder(boxes, tree.survey, executor);
        seen_tree = &tree;
    }
    void update(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) {
        tree.refit(boxes, moved, executor);
    }
    std::size_t bytes() const { return 0; }
};

/// The bounds of every block but the root's, each from the items below it.
void add_blocks(const PackedLayout& tree, std::uint32_t ref, Boxes boxes, Box& bounds,
                std::vector<Box>& blocks) {
    const bool leaf = PackedLayout::is_leaf(ref);
    const PackedView view = leaf ? tree.leaf(ref) : tree.block(ref);
    for (std::uint32_t lane = 0; lane < view.count; ++lane) {
        Box below;
        if (leaf) {
            below = boxes[view.ref[lane]];
        } else {
            add_blocks(tree, view.ref[lane], boxes, below, blocks);
            blocks.push_back(below);
        }
        bounds.extend(below);
    }
}

double brute_force_sah(const PackedLayout& tree, Boxes boxes) {
    Box root;
    std::vector<Box> blocks;
    add_blocks(tree, tree.root(), boxes, root, blocks);
    double tests = 16;
    for (const Box& block : blocks)
        tests += 16 * block.half_area() / root.half_area();
    return tests;
}

/// Whether the line through `at` along `along` meets the box: by slabs, in double.
bool meets(const Box& box, const double (&at)[3], const double (&along)[3]) {
    const double low[3]{box.min.x, box.min.y, box.min.z}, high[3]{box.max.x, box.max.y, box.max.z};
    double from = -1e300, to = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (low[axis] - at[axis]) / along[axis],
                     b = (high[axis] - at[axis]) / along[axis];
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from <= to;
}

TEST(Sah, IsTheSumOverTheBlocksInEveryFrame) {
    for (const std::size_t n : {1u, 16u, 17u, 300u, 5000u}) {
        std::vector<Box> boxes = random_boxes(n, .1f, 3);
        UpdaterOf<Shown> updater({});
        updater.start(boxes, serial());
        const double fresh = updater.sah();
        std::vector<std::uint32_t> moved;
        for (std::uint32_t i = 0; i < n; i += 3) {
            moved.push_back(i);
            std::swap(boxes[i].min.x, boxes[i].min.y);
            std::swap(boxes[i].max.x, boxes[i].max.y);
        }
        for (const bool is_later : {false, true}) {
            if (is_later)
                updater.update(boxes, moved, serial());
            else
                updater.start(boxes, serial());
            const double expected = brute_force_sah(seen_tree->layout(), boxes);
            EXPECT_NEAR(updater.sah(), expected, 1e-5 * expected) << n;
        }
        if (n <= 16)
            EXPECT_EQ(fresh, 16);
        else
            EXPECT_GT(fresh, 16);
    }
}

TEST(Sah, IsWhatRandomLinesTest) {
    const std::vector<Box> boxes = random_boxes(2000, .1f, 5);
    UpdaterOf<Shown> updater({});
    updater.start(boxes, serial());
    Box root;
    std::vector<Box> blocks;
    add_blocks(seen_tree->layout(), seen_tree->layout().root(), boxes, root, blocks);
    // Uniform lines through a ball around everything: any direction, and a point of the disc
    // across.
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0, 1);
    const double middle = .55, radius = 1.1;
    std::size_t lines = 0, tests = 0;
    while (lines < 20000) {
        double along[3]{normal(random), normal(random), normal(random)};
        const double length = std::hypot(along[0], along[1], along[2]);
        for (double& x : along)
            x /= length;
        double across[3]{normal(random), normal(random), normal(random)};
        const double dot = across[0] * along[0] + across[1] * along[1] + across[2] * along[2];
        for (int i = 0; i < 3; ++i)
            across[i] -= dot * along[i];
        const double far =
            radius * std::sqrt(uniform(random)) / std::hypot(across[0], across[1], across[2]);
        const double at[3]{middle + far * across[0], middle + far * across[1],
                           middle + far * across[2]};
        if (!meets(root, at, along))
            continue;
        ++lines;
        tests += 16;
        for (const Box& block : blocks)
            tests += meets(block, at, along) ? 16 : 0;
    }
    const double mean = static_cast<double>(tests) / static_cast<double>(lines);
    EXPECT_NEAR(updater.sah() / mean, 1, .02);
}

TEST(Sah, OfNothingIsNothingAndOfPointsUnknown) {
    for (const UpdateEntry& entry : updates()) {
        const std::unique_ptr<Updater> updater = entry.make({});
        EXPECT_EQ(updater->sah(), 0) << entry.name << ", before the start";
        updater->start(std::vector<Box>{}, serial());
        EXPECT_EQ(updater->sah(), 0) << entry.name;
        updater->start(std::vector<Box>(40), serial());
        EXPECT_EQ(updater->sah(), 0) << entry.name << ", all absent";
        for (const float x : {1.f, 1e30f}) { // a point, and an area beyond floats
            updater->start(std::vector<Box>(40, Box{{1, 1, 1}, {x, x, x}}), serial());
            if (x > 1 || !(entry.name == "cached" || entry.name == "auto")) { // they widen boxes
                EXPECT_TRUE(std::isnan(updater->sah())) << entry.name << " " << x;
            }
        }
        updater->start(std::vector<Box>(40, Box{{0, 0, 0}, {1, 1, 1}}), serial());
        EXPECT_NEAR(updater->sah(), 16 * (1 + 3), 1e-4) // three leaves as large as the root
            << entry.name;
    }
}

} // namespace
} // namespace boxwood
