#include "trees/dynamic/dynamic_tree.h"

#include "trees/inspect/quality.h"
#include "trees/inspect/validate.h"
#include "trees/testing/box_families.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>

namespace boxwood {
namespace {

using Model = std::map<std::uint32_t, Box>;

/// The bound that the header promises.
std::size_t max_height(std::size_t n) {
    return n < 2 ? 0 : static_cast<std::size_t>(3.5 * std::log2(static_cast<double>(n)));
}

/// What is wrong with the tree, given what it should hold; empty if nothing. The tree of to_tree's
/// items are renumbered 0 .. n - 1 in the order of their numbers, as `validate` wants them.
std::string fault(const DynamicTree& tree, const Model& model) {
    if (tree.size() != model.size() || tree.empty() != model.empty())
        return "size " + std::to_string(tree.size());
    Tree canonical = tree.to_tree();
    if (!std::ranges::equal(tree.order(), canonical.order))
        return "the order is not that of the tree of to_tree";
    std::vector<Box> boxes;
    std::map<std::uint32_t, std::uint32_t> rank;
    for (const auto& [item, box] : model) {
        if (!tree.contains(item) || !(tree.box(item) == box))
            return "box of item " + std::to_string(item);
        rank[item] = static_cast<std::uint32_t>(boxes.size());
        boxes.push_back(box);
    }
    for (std::uint32_t& item : canonical.order) {
        if (!rank.contains(item))
            return "a stranger, item " + std::to_string(item);
        item = rank[item];
    }
    const auto wrong = validate(canonical, boxes);
    if (wrong)
        return *wrong;
    if (tree.height() != quality(canonical, boxes, {.epo_visits = 0}).depth_max)
        return "height " + std::to_string(tree.height()) + " is not the depth";
    if (tree.height() > max_height(model.size()))
        return "height " + std::to_string(tree.height()) + " of " + std::to_string(model.size());
    return "";
}

/// Few distinct coordinates, so that flat, identical, nested and touching boxes are common.
rc::Gen<Box> any_box() {
    return rc::gen::map(rc::gen::container<std::vector<int>>(6, rc::gen::inRange(-3, 4)),
                        [](const std::vector<int>& v) {
                            Box box;
                            const auto f = [&](std::size_t i) { return static_cast<float>(v[i]); };
                            box.extend(Vec3<float>{f(0), f(1), f(2)});
                            box.extend(Vec3<float>{f(3), f(4), f(5)});
                            return box;
                        });
}

RC_GTEST_PROP(DynamicTree, HoldsWhatAMapHolds, ()) {
    DynamicTree tree;
    Model model;
    const auto steps = *rc::gen::container<std::vector<std::pair<int, std::uint32_t>>>(
        rc::gen::pair(rc::gen::inRange(0, 9), rc::gen::inRange<std::uint32_t>(0, 24)));
    for (const auto& [what, item] : steps) {
        const bool known = model.contains(item);
        const Box box = *any_box();
        if (what == 8) {
            const Box larger = known ? merge(model[item], box) : box;
            if (known) {
                tree.enlarge(item, larger);
                model[item] = larger;
            } else {
                RC_ASSERT_THROWS_AS(tree.enlarge(item, larger), std::invalid_argument);
            }
        } else if (what < 4) {
            if (known) {
                RC_ASSERT_THROWS_AS(tree.insert(item, box), std::invalid_argument);
            } else {
                tree.insert(item, box);
                model[item] = box;
            }
        } else if (what < 6) {
            if (known) {
                tree.move(item, box);
                model[item] = box;
            } else {
                RC_ASSERT_THROWS_AS(tree.move(item, box), std::invalid_argument);
            }
        } else if (known) {
            tree.remove(item);
            model.erase(item);
        } else {
            RC_ASSERT_THROWS_AS(tree.remove(item), std::invalid_argument);
        }
        RC_ASSERT(fault(tree, model) == "");
    }
}

/// Longer histories than RapidCheck's, on real-valued boxes, with growth and decline.
TEST(DynamicTree, LongRandomHistory) {
    std::mt19937 random(5);
    const auto boxes = random_boxes(4000, .2f, 6);
    DynamicTree tree;
    Model model;
    for (std::size_t step = 0; step < boxes.size(); ++step) {
        const std::uint32_t item = static_cast<std::uint32_t>(random() % 150);
        const bool growing = step % 1000 < 600;
        if (!model.contains(item)) {
            if (growing || step % 4 == 0) {
                tree.insert(item, boxes[step]);
                model[item] = boxes[step];
            }
        } else if (step % 3 == 0) {
            tree.move(item, boxes[step]);
            model[item] = boxes[step];
        } else if (!growing || step % 3 == 1) {
            tree.remove(item);
            model.erase(item);
        }
        ASSERT_EQ(fault(tree, model), "") << "step " << step;
    }
    while (!model.empty()) {
        tree.remove(model.begin()->first);
        model.erase(model.begin());
        ASSERT_EQ(fault(tree, model), "") << model.size() << " left";
    }
}

TEST(DynamicTree, EveryFamilyInEveryOrder) {
    for (const BoxFamily& family : box_families()) {
        const auto n = static_cast<std::uint32_t>(family.boxes.size());
        Model model;
        DynamicTree forth, back, moved;
        for (std::uint32_t i = 0; i < n; ++i) {
            model[i] = family.boxes[i];
            forth.insert(i, family.boxes[i]);
            back.insert(n - 1 - i, family.boxes[n - 1 - i]);
            moved.insert(i, {{0, 0, 0}, {1, 1, 1}});
        }
        for (std::uint32_t i = 0; i < n; ++i)
            moved.move(i, family.boxes[i]);
        EXPECT_EQ(fault(forth, model), "") << family.name;
        EXPECT_EQ(fault(back, model), "") << family.name;
        EXPECT_EQ(fault(moved, model), "") << family.name;
    }
}

/// Histories that make a chain of a tree that looks at areas alone.
TEST(DynamicTree, SortedAndNestedBoxesStayShallow) {
    constexpr std::uint32_t n = 20000;
    const auto at = [](float x, float r) { return Box{{x - r, -r, -r}, {x + r, r, r}}; };
    const std::pair<const char*, std::function<Box(float)>> orders[]{
        {"along a line", [&](float i) { return at(i, .4f); }},
        {"back along it", [&](float i) { return at(-i, .6f); }},
        {"points along a line", [&](float i) { return at(i, 0); }},
        {"ever larger", [&](float i) { return at(0, i); }},
        {"ever smaller", [&](float i) { return at(0, n - i); }},
        {"by octaves", [&](float i) { return at(std::exp2(i * (240.f / n) - 120), 0); }},
        {"identical", [&](float) { return at(1, 1); }},
    };
    for (const auto& [name, box] : orders) {
        DynamicTree tree;
        Model model;
        for (std::uint32_t i = 0; i < n; ++i) {
            model[i] = box(static_cast<float>(i));
            tree.insert(i, model[i]);
        }
        EXPECT_EQ(fault(tree, model), "") << name;
        for (std::uint32_t i = 0; i < n; ++i)
            if (i % 16 != 0) {
                tree.remove(i);
                model.erase(i);
            }
        EXPECT_EQ(fault(tree, model), "") << name << ", after removals";
    }
}

double sah_cost(const DynamicTree& tree, const std::vector<Box>& boxes) {
    return quality(tree.to_tree(), boxes, {.epo_visits = 0}).sah_cost;
}

DynamicTree insert_all(const std::vector<Box>& boxes) {
    DynamicTree tree;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        tree.insert(i, boxes[i]);
    return tree;
}

/// A search or a rotation that goes wrong still gives a valid tree, only a worse one.
TEST(DynamicTree, StaysGood) {
    auto boxes = random_boxes(5000, .02f, 12);
    DynamicTree tree = insert_all(boxes);
    EXPECT_LT(sah_cost(tree, boxes), 52); // measured: 48.4
    const auto others = random_boxes(5000, .02f, 13);
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        tree.move(i, others[i]);
    EXPECT_LT(sah_cost(tree, others), 52) << "after teleports";

    boxes = others;
    for (int frame = 0; frame < 30; ++frame)
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            const Vec3<float> step{static_cast<float>(i % 7) * 2e-3f - 6e-3f,
                                   static_cast<float>(i % 5) * 2e-3f - 4e-3f, 0};
            boxes[i] = {boxes[i].min + step, boxes[i].max + step};
            tree.move(i, boxes[i]);
        }
    EXPECT_LT(sah_cost(tree, boxes), 1.1 * sah_cost(insert_all(boxes), boxes)) << "after a drift";
}

TEST(DynamicTree, PointsOnALineAreToldApart) {
    std::vector<Box> points;
    for (const Box& box : random_boxes(2000, 0, 17))
        points.push_back({{box.min.x, 0, 0}, {box.min.x, 0, 0}});
    const Tree tree = insert_all(points).to_tree();
    EXPECT_LT(quality(tree, points).overlap, .05);
}

TEST(DynamicTree, SmallMovesKeepTheShape) {
    DynamicTree tree;
    auto boxes = random_boxes(100, .1f, 14);
    for (std::uint32_t i = 0; i < 100; ++i)
        tree.insert(i, boxes[i]);
    for (std::uint32_t i = 0; i < 100; ++i)
        tree.move(i, tree.box((i + 1) % 100)); // a reference into the tree itself
    for (std::uint32_t i = 0; i < 99; ++i)
        EXPECT_EQ(tree.box(i), boxes[i + 1]);
    const auto order = tree.to_tree();
    for (std::uint32_t i = 0; i < 100; ++i)
        tree.move(i, tree.box(i));
    EXPECT_TRUE(std::ranges::equal(order.order, tree.to_tree().order));
}

TEST(DynamicTree, BadInputIsNamedAndChangesNothing) {
    DynamicTree tree;
    const Box good{{0, 0, 0}, {1, 1, 1}};
    tree.insert(3, good);
    tree.insert(5, good);
    constexpr float inf = std::numeric_limits<float>::infinity();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), inf, -inf, -1.f}) {
        Box box = good;
        box.max.y = bad;
        EXPECT_THAT([&] { tree.insert(4, box); },
                    testing::Throws<InvalidBox>(testing::Field(&InvalidBox::index, 4u)))
            << bad;
        EXPECT_THROW(tree.move(3, box), InvalidBox);
        EXPECT_THROW(tree.enlarge(3, box), InvalidBox);
    }
    EXPECT_THROW(tree.insert(4, Box{}), InvalidBox);
    EXPECT_THROW(tree.insert(3, good), std::invalid_argument);
    EXPECT_THROW(tree.insert(max_items, good), std::length_error);
    EXPECT_THROW(tree.remove(4), std::invalid_argument);
    EXPECT_THROW(tree.remove(~0u), std::invalid_argument);
    EXPECT_THROW(tree.move(4, good), std::invalid_argument);
    EXPECT_THROW(tree.enlarge(4, good), std::invalid_argument);
    EXPECT_THROW(tree.enlarge(3, {{0, 0, 0}, {1, 1, .5f}}), std::invalid_argument);
    EXPECT_THROW(tree.box(4), std::invalid_argument);
    EXPECT_EQ(fault(tree, {{3, good}, {5, good}}), "");
}

TEST(DynamicTree, MemoryIsUsedAgain) {
    DynamicTree tree;
    tree.reserve(100);
    const std::size_t bytes = tree.bytes();
    const auto boxes = random_boxes(100, .1f, 15);
    for (int round = 0; round < 3; ++round) {
        Model model;
        for (std::uint32_t i = 0; i < 100; ++i) {
            tree.insert(i, boxes[i]);
            model[i] = boxes[i];
        }
        EXPECT_EQ(fault(tree, model), "");
        for (std::uint32_t i = 0; i < 1000; ++i) {
            tree.remove(i % 100);
            tree.insert(i % 100, boxes[(i * 7) % 100]);
        }
        EXPECT_EQ(tree.bytes(), bytes);
        tree.clear();
        EXPECT_EQ(fault(tree, {}), "");
        EXPECT_FALSE(tree.contains(1));
    }
}

} // namespace
} // namespace boxwood
