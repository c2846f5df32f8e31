#include "kernels/testing/every_target.h"
#include "trees/builder.h"
#include "trees/builders/top_down.h"
#include "trees/inspect/quality.h"
#include "trees/inspect/validate.h"
#include "trees/testing/box_families.h"
#include "trees/testing/each_builder.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/same_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace boxwood {
namespace {

std::vector<std::string> builder_names() {
    std::vector<std::string> names;
    for (const BuilderEntry& builder : builders())
        names.emplace_back(builder.name);
    return names;
}
INSTANTIATE_TEST_SUITE_P(, EachBuilder, testing::ValuesIn(builder_names()),
                         [](const auto& of) { return of.param; });

TEST_P(EachBuilder, MakesValidTreesOfEveryFamily) {
    for (const BoxFamily& family : box_families())
        for (const ExecutorEntry& executor : executors()) {
            const Tree tree =
                build(family.boxes, *executor.make(std::min(2u, executor.max_threads)));
            ASSERT_EQ(tree.size(), family.boxes.size());
            const auto fault = validate(tree, family.boxes);
            EXPECT_FALSE(fault) << family.name << ": " << *fault;
        }
}

/// The default and both ends of a range, or each choice.
std::vector<SettingValue> extremes(const SettingInfo& setting) {
    std::vector<SettingValue> values{setting.default_value};
    for (const std::string_view choice : setting.choices)
        values.push_back(std::string(choice));
    for (const double end : {setting.min, setting.max}) {
        if (std::holds_alternative<double>(setting.default_value))
            values.push_back(end);
        else if (std::holds_alternative<std::int64_t>(setting.default_value))
            values.push_back(static_cast<std::int64_t>(end));
    }
    return values;
}

TEST_P(EachBuilder, MakesValidTreesByEveryFiniteSetting) {
    const std::vector<Box> boxes = random_boxes(3000, .1f, 4);
    for (const SettingInfo& setting : builder_.settings)
        for (const SettingValue& value : extremes(setting)) {
            const Settings settings{{std::string(setting.name), value}};
            const Tree tree = builder_.make(settings)(boxes, serial());
            EXPECT_FALSE(validate(tree, boxes)) << setting.name << " " << to_text(value);
        }
}

TEST(TopDown, MakesValidTreesBySplitsOfOnesOwn) {
    for (const BoxFamily& family : box_families()) {
        // One item goes left each time, but for the depth limit: the worst of splits.
        const auto one_left = [](std::span<BuildItem>) { return std::size_t{1}; };
        const Tree tree = build_top_down(family.boxes, serial(), one_left);
        EXPECT_EQ(validate(tree, family.boxes).value_or(""), "") << family.name;
        EXPECT_LE(quality(tree, family.boxes).depth_max,
                  3u * std::bit_width(family.boxes.size()) + 33);
        for (const auto& [name, executor] : parallel_executors())
            EXPECT_TRUE(same_tree(tree, build_top_down(family.boxes, *executor, one_left))) << name;
    }
}

TEST(MedianBuilder, HasTheLeastDepth) {
    for (const std::size_t n : {1u, 2u, 3u, 1000u, 1024u, 1025u}) {
        const std::vector<Box> boxes = random_boxes(n, .1f, 5);
        const Tree tree = find_builder("median").make({})(boxes, serial());
        EXPECT_EQ(quality(tree, boxes).depth_max, std::bit_width(n - 1)) << n;
    }
}

TEST(BinnedSahBuilder, CostsNoMoreThanMedianOnBoxesOfManySizes) {
    std::vector<Box> boxes = random_boxes(4000, .01f, 6);
    for (std::size_t i = 0; i < boxes.size(); i += 20)
        boxes[i].max = boxes[i].min + Vec3<float>{.5f, .3f, .4f};
    const double median = quality(find_builder("median").make({})(boxes, serial()), boxes).sah_cost;
    const double sah =
        quality(find_builder("binned_sah").make({})(boxes, serial()), boxes).sah_cost;
    EXPECT_LT(sah, .8 * median);
}

TEST(BinnedSahBuilder, LeavesWholeNodesAsTheyLieAndSplitsTheOthersAlike) {
    const std::vector<Box> boxes = random_boxes(5000, .03f, 7);
    for (const int whole : {2, 8, 16}) {
        const Settings agglomerated{{"leaf_size", 8}, {"agglomerate_below", whole}};
        Settings halved = agglomerated;
        halved["unsplit_below"] = whole;
        const Tree a = make_builder("binned_sah", agglomerated)(boxes, serial());
        const Tree b = make_builder("binned_sah", halved)(boxes, serial());
        EXPECT_FALSE(validate(b, boxes)) << whole;
        const auto limit = static_cast<std::uint32_t>(whole);
        std::size_t larger = 0, inner = 0;
        for (std::size_t i = 0; i < b.nodes.size(); ++i) {
            const TreeNode& node = b.nodes[i];
            larger += node.count > limit;
            if (node.count <= limit && node.count > 1) {
                ++inner;
                ASSERT_EQ(b.nodes[Tree::left(i)].count, node.count / 2) << i;
            }
        }
        // Numbered by their items, so those above stand in the same places with the same boxes.
        ASSERT_GT(larger, 300u);
        ASSERT_GT(inner, 1000u);
        for (std::size_t i = 0; i < a.nodes.size(); ++i)
            if (a.nodes[i].count > limit || b.nodes[i].count > limit) {
                ASSERT_EQ(a.nodes[i].count, b.nodes[i].count) << i;
                ASSERT_EQ(a.nodes[i].first, b.nodes[i].first) << i;
                ASSERT_EQ(a.nodes[i].box, b.nodes[i].box) << i;
            }
    }
}

TEST(BinnedSahBuilder, DepthIsBoundedOnGeometricSpacing) {
    // Each bin plane can cut off but a few of these boxes: without the limit the
    // depth is linear.
    std::vector<Box> boxes;
    for (int i = 0; i < 20000; ++i) {
        const float x = std::exp2(static_cast<float>(i % 230 - 125)) * (1 + static_cast<float>(i));
        boxes.push_back({{x, 0, 0}, {x, 0, 0}});
    }
    const Tree tree = find_builder("binned_sah").make({{"bins", 2}})(boxes, serial());
    EXPECT_FALSE(validate(tree, boxes));
    const std::uint64_t depth = quality(tree, boxes).depth_max;
    EXPECT_LE(depth, 3u * std::bit_width(boxes.size()) + 33);
    EXPECT_GT(depth, 2u * std::bit_width(boxes.size()) + 17) << "the limit was not put to the test";
}

TEST_P(EachBuilder, MakesTheSameTreeOnEveryExecutorAndInstructionSet) {
    std::vector<Box> boxes = random_boxes(30000, .05f, 10);
    for (std::size_t i = 0; i < 9000; ++i)
        boxes[3 * i] = boxes[i];
    for (const std::vector<Box>& set : {boxes, random_boxes(20000, .05f, 3)}) {
        const Tree expected = build(set);
        for (const auto& [name, executor] : parallel_executors())
            EXPECT_TRUE(same_tree(expected, build(set, *executor))) << name;
        on_every_target([&] { EXPECT_TRUE(same_tree(expected, build(set))); });
    }
}

TEST(Builders, RankByCostOnBoxesOfManySizes) {
    std::vector<Box> boxes = random_boxes(20000, .01f, 11);
    for (std::size_t i = 0; i < boxes.size(); i += 10)
        boxes[i].max = boxes[i].min + Vec3<float>{.1f, .3f, .02f};
    const auto cost = [&](std::string_view name, const Settings& settings = {}) {
        return quality(make_builder(name, settings)(boxes, serial()), boxes).sah_cost;
    };
    const double sweep = cost("sweep_sah"), binned = cost("binned_sah", {{"agglomerate_below", 1}});
    EXPECT_LT(cost("binned_sah"), binned);
    EXPECT_LT(sweep, binned);
    EXPECT_LT(binned, 1.05 * sweep);
    EXPECT_LT(1.1 * binned, cost("median"));
}

TEST_P(EachBuilder, SparesSumsAndAreasOfHugeBoxesFromOverflow) {
    constexpr float huge = 3e38f;
    std::vector<Box> boxes;
    for (int i = 0; i < 1000; ++i) {
        const auto at = [&](int k) { return static_cast<float>(i * k % 1000 - 500) / 500 * huge; };
        const Vec3<float> p{at(1), at(7), at(13)};
        boxes.push_back({p, p});
    }
    boxes.push_back({{-huge, -huge, -huge}, {huge, huge, huge}});
    const Tree tree = build(boxes);
    EXPECT_EQ(validate(tree, boxes).value_or(""), "");
    // Halves of a tree that sees nothing would be as large as the whole.
    EXPECT_LT(quality(tree, boxes).sah_cost, 120);
}

} // namespace
} // namespace boxwood
