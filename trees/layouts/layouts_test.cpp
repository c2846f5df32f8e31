#include "kernels/arithmetic/rounding.h"
#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/layouts/binary.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"
#include "trees/queries/self_pairs.h"
#include "trees/testing/box_families.h"
#include "trees/testing/each_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace boxwood {
namespace {

template <class Real> Aabb<Real> as(const Box& box) { return static_cast<Aabb<Real>>(box); }

/// Each item once and with its own box, child boxes around what is below, counts and bounds right.
template <WideTree L> void expect_sound(const L& layout, Boxes boxes) {
    using Real = typename L::Real;
    ASSERT_EQ(layout.size(), boxes.size());
    ASSERT_EQ(layout.empty(), boxes.empty());
    if (boxes.empty())
        return;
    struct Open {
        std::uint32_t ref;
        Aabb<Real> around; ///< the lane that led here
        std::size_t depth;
    };
    std::vector<int> seen(boxes.size(), 0);
    std::vector<Open> open{{layout.root(), layout.bounds(), 1}};
    std::size_t depth = 0, visited = 0;
    const auto check = [&](const auto& block, std::size_t max_count, const Open& at) {
        EXPECT_GE(block.count, boxes.size() == 1 ? 1u : at.depth == 1 ? 2u : 1u);
        EXPECT_LE(block.count, max_count);
        EXPECT_TRUE(at.around.contains(block.bounds));
        Aabb<Real> all;
        for (std::uint32_t lane = 0; lane < block.count; ++lane)
            all.extend(block.lane(lane));
        EXPECT_TRUE(all.contains(block.bounds));
    };
    while (!open.empty()) {
        const Open at = open.back();
        open.pop_back();
        depth = std::max(depth, at.depth);
        ++visited;
        if (L::is_leaf(at.ref)) {
            ASSERT_LT(L::index(at.ref), layout.leaf_slots());
            const auto& leaf = layout.leaf(at.ref);
            check(leaf, L::width, at);
            for (std::uint32_t lane = 0; lane < leaf.count; ++lane) {
                ++seen[leaf.ref[lane]];
                ASSERT_EQ(leaf.lane(lane), as<Real>(boxes[leaf.ref[lane]]));
                ASSERT_TRUE(leaf.bounds.contains(leaf.lane(lane)));
            }
        } else {
            const auto& block = layout.block(at.ref);
            check(block, L::width, at);
            EXPECT_GE(block.count, 2u);
            std::uint32_t items = 0;
            for (std::uint32_t lane = 0; lane < block.count; ++lane) {
                const std::uint32_t ref = block.ref[lane];
                open.push_back({ref, block.lane(lane), at.depth + 1});
                items += L::is_leaf(ref) ? layout.leaf(ref).count : layout.block(ref).items;
            }
            EXPECT_EQ(items, block.items);
        }
    }
    EXPECT_EQ(depth, layout.depth());
    EXPECT_LE(visited, 2 * boxes.size());
    EXPECT_EQ(std::ranges::count(seen, 1), static_cast<std::ptrdiff_t>(boxes.size()));
}

template <class F> void for_each_wide(const F& f) {
    f.template operator()<Wide4Layout>();
    f.template operator()<Wide8Layout>();
    f.template operator()<Wide16Layout>();
    f.template operator()<Wide8LayoutF64>();
    f.template operator()<Quantised8Layout>();
}

TEST_P(EachBuilder, WideLayoutsHoldEachItemOnceWithinItsBounds) {
    for (const BoxFamily& family : box_families()) {
        SCOPED_TRACE(family.name);
        const Tree tree = build(family.boxes);
        for_each_wide([&]<class L>() {
            SCOPED_TRACE(L::name);
            expect_sound(L(tree, serial()), family.boxes);
        });
    }
}

TEST(WideLayouts, AreTheSameOnEveryExecutor) {
    const std::vector<Box> boxes = random_boxes(30000, .05f, 4);
    const Tree tree = find_builder("binned_sah").make({})(boxes, serial());
    for_each_wide([&]<class L>() {
        SCOPED_TRACE(L::name);
        const L expected(tree, serial());
        std::vector<Pair> expected_pairs;
        AppendPairs expected_sink(expected_pairs);
        self_pairs(expected, serial(), expected_sink);
        for (const std::string_view name : {"openmp", "tbb"})
            for (const unsigned threads : {2u, 4u}) {
                const auto executor = make_executor(name, threads);
                const L made(tree, *executor);
                ASSERT_EQ(made.blocks().size(), expected.blocks().size());
                EXPECT_EQ(made.bytes(), expected.bytes());
                EXPECT_EQ(made.depth(), expected.depth());
                std::size_t differing = 0;
                for (std::size_t i = 0; i < made.blocks().size(); ++i) {
                    const auto& a = made.blocks()[i];
                    const auto& b = expected.blocks()[i];
                    differing += a.count != b.count || a.items != b.items ||
                                 !(a.bounds == b.bounds) ||
                                 !std::equal(a.ref, a.ref + a.count, b.ref) ||
                                 std::memcmp(a.plane, b.plane, sizeof a.plane) != 0;
                }
                EXPECT_EQ(differing, 0u);
                std::vector<Pair> pairs;
                AppendPairs sink(pairs);
                self_pairs(made, *executor, sink);
                EXPECT_EQ(pairs, expected_pairs);
            }
    });
}

TEST(QuantisedBlock, ContainsItsChildrenWhateverTheFloats) {
    std::mt19937 random(5);
    const auto bits = [&] { return std::bit_cast<float>(static_cast<std::uint32_t>(random())); };
    const auto near = [&](float x) { // a few ulps away
        for (auto i = random() % 6; i > 0; --i)
            x = std::nextafter(x, random() % 2 ? 1e30f : -1e30f);
        return x;
    };
    double slack = 0;
    std::size_t blocks = 0;
    for (int round = 0; round < 60000; ++round) {
        const float scale = std::ldexp(1.0f, static_cast<int>(random() % 250) - 125);
        const float centre = bits();
        std::vector<Box> children(1 + random() % 8);
        Box bounds;
        for (Box& child : children) {
            for (int axis = 0; axis < 3; ++axis)
                for (Vec3<float>* p : {&child.min, &child.max}) {
                    float x = round % 4 == 0   ? bits()
                              : round % 4 == 1 ? near(centre)
                              : round % 4 == 2
                                  ? scale * static_cast<float>(random() % 1000)
                                  : centre + scale * static_cast<float>(random() % 1000);
                    (*p)[axis] = std::isfinite(x) ? x : 0;
                }
            child = {min(child.min, child.max), max(child.min, child.max)};
            bounds.extend(child);
        }
        const QuantisedBlock block = quantised(bounds, children);
        for (std::uint32_t lane = 0; lane < block.count; ++lane) {
            ASSERT_TRUE(block.lane(lane).contains(children[lane])) << round << " " << lane;
            if (round % 4 != 2)
                continue;
            const double wide =
                static_cast<double>(bounds.max.x) - static_cast<double>(bounds.min.x);
            if (wide <= 0)
                continue;
            slack = std::max(slack, (static_cast<double>(children[lane].min.x) -
                                     static_cast<double>(block.lane(lane).min.x)) /
                                        wide);
            ++blocks;
        }
    }
    EXPECT_GT(blocks, 1000u);
    EXPECT_LT(slack, 1.01 / 255) << "planes should be less than a step away";
}

TEST_P(EachBuilder, Quantised8LayoutTakesLessMemory) {
    const Tree tree = build(random_boxes(20000, .02f, 4));
    // Leaves are exact: those of few items, of trees cut by number, save little.
    const double share = builder_.name == "hilbert" ? .95 : .77;
    EXPECT_LT(static_cast<double>(Quantised8Layout(tree, serial()).bytes()),
              share * static_cast<double>(Wide8Layout(tree, serial()).bytes()));
}

/// Boxes of doubles that overlap by less than a float can tell.
std::vector<Aabb<double>> close_boxes(std::size_t n) {
    std::mt19937 random(3);
    std::vector<Aabb<double>> boxes(n);
    const auto cell = [&] { return 1 + static_cast<double>(random() % 8) / 8; };
    for (Aabb<double>& box : boxes) {
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = cell() + static_cast<double>(random() % 3) * 0x1p-50;
            box.max[axis] = box.min[axis] + .125 - static_cast<double>(random() % 3) * 0x1p-50;
        }
    }
    return boxes;
}

TEST_P(EachBuilder, LayoutsOfDoublesAnswerPairsOfDoublesExactly) {
    const std::vector<Aabb<double>> boxes = close_boxes(1500);
    std::vector<Box> floats;
    for (const Aabb<double>& box : boxes)
        floats.push_back(round_outward(box));
    std::vector<Pair> expected;
    std::size_t of_floats = 0;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
            if (overlaps(boxes[i], boxes[j]))
                expected.push_back({i, j});
            of_floats += overlaps(floats[i], floats[j]);
        }
    ASSERT_GT(of_floats, expected.size() + 100) << "floats would do";
    const Tree tree = build(floats);
    std::size_t with_doubles = 0;
    for (const LayoutEntry& entry : layouts()) {
        EXPECT_EQ(entry.make_of_doubles != nullptr, entry.precision == "f64");
        if (!entry.make_of_doubles)
            continue;
        SCOPED_TRACE(entry.name);
        ++with_doubles;
        const auto layout = entry.make_of_doubles(tree, boxes, serial());
        std::vector<Pair> pairs;
        AppendPairs sink(pairs);
        layout->self_pairs(serial(), sink);
        std::ranges::sort(pairs);
        EXPECT_EQ(pairs, expected);
        const auto half = entry.make_of_doubles(tree, boxes, serial());
        CountPairs both;
        layout->tree_pairs(*half, serial(), both);
        EXPECT_EQ(both.count(), 2 * expected.size() + boxes.size());
    }
    EXPECT_EQ(with_doubles, 2u);
}

TEST(LayoutsOfDoubles, RefuseBadBoxesByIndexAndOtherCounts) {
    std::vector<Aabb<double>> boxes = close_boxes(20);
    std::vector<Box> floats;
    for (const Aabb<double>& box : boxes)
        floats.push_back(round_outward(box));
    const Tree tree = find_builder("median").make({})(floats, serial());
    boxes[7].max.y = std::nan("");
    for (const LayoutEntry& entry : layouts())
        if (entry.make_of_doubles) {
            EXPECT_THAT([&] { entry.make_of_doubles(tree, boxes, serial()); },
                        testing::Throws<InvalidBox>(testing::Field(&InvalidBox::index, 7u)))
                << entry.name;
            EXPECT_THROW(entry.make_of_doubles(tree, {boxes.data(), 6}, serial()),
                         std::invalid_argument);
        }
}

} // namespace
} // namespace boxwood
