#include "kernels/testing/every_target.h"
#include "trees/layouts/packed.h"
#include "trees/ordering/curve_order.h"
#include "trees/queries/self_pairs.h"
#include "trees/queries/tree_pairs.h"
#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace boxwood {
using namespace detail;
namespace {

std::vector<std::uint32_t> shuffled(std::size_t n) {
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    return order;
}

std::vector<Pair> brute_force(Boxes a, Boxes b) {
    std::vector<Pair> pairs;
    for (std::uint32_t i = 0; i < a.size(); ++i)
        for (std::uint32_t j = 0; j < b.size(); ++j)
            if (overlaps(a[i], b[j]))
                pairs.push_back({i, j});
    return pairs;
}

PackedLayout in_curve_order(Boxes boxes) {
    return PackedLayout::of_order(boxes, coarse_curve_order(boxes, Curve::hilbert, serial()).span(),
                                  serial());
}

TEST(PackedLayout, BoundsEveryBlockExactly) {
    for (const std::size_t n : {0u, 1u, 15u, 16u, 17u, 256u, 257u, 5000u}) {
        SCOPED_TRACE(n);
        const std::vector<Box> boxes = random_boxes(n, .1f, 5);
        const std::vector<std::uint32_t> order = shuffled(n);
        for (const unsigned threads : {1u, 3u}) {
            const auto executor = make_executor("openmp", threads);
            const PackedLayout layout = PackedLayout::of_order(boxes, order, *executor);
            ASSERT_EQ(layout.size(), n);
            if (n == 0)
                continue;
            for (std::size_t slot = 0; slot < n; ++slot) {
                EXPECT_EQ(layout.items()[slot], order[slot]);
                EXPECT_EQ(layout.level(0)[slot / 16].lane(slot % 16), boxes[order[slot]]);
            }
            for (std::size_t l = 0; l < layout.depth(); ++l)
                for (std::size_t b = 0; b < layout.level(l).size(); ++b) {
                    Box bounds;
                    for (std::size_t lane = 0; lane < 16; ++lane)
                        bounds.extend(layout.level(l)[b].lane(lane));
                    EXPECT_EQ(bounds, l + 1 < layout.depth()
                                          ? layout.level(l + 1)[b / 16].lane(b % 16)
                                          : layout.bounds());
                }
            EXPECT_EQ(layout.level(layout.depth() - 1).size(), 1u);
        }
    }
    EXPECT_THROW(PackedLayout::of_order(random_boxes(3, .1f, 5), shuffled(4), serial()),
                 std::invalid_argument);
}

TEST(PackedLayout, ShowsItsBlocksToTraversals) {
    for (const std::size_t n : {1u, 16u, 17u, 300u, 5000u}) {
        SCOPED_TRACE(n);
        const std::vector<Box> boxes = random_boxes(n, .1f, 5);
        const PackedLayout layout = PackedLayout::of_order(boxes, shuffled(n), serial());
        std::vector<bool> seen(n, false);
        struct Open {
            std::uint32_t ref;
            Box bounds;
        };
        std::vector<Open> open{{layout.root(), layout.bounds()}};
        while (!open.empty()) {
            const Open top = open.back();
            open.pop_back();
            const bool leaf = PackedLayout::is_leaf(top.ref);
            const PackedView view = leaf ? layout.leaf(top.ref) : layout.block(top.ref);
            Box bounds;
            for (std::uint32_t i = 0; i < view.count; ++i) {
                bounds.extend(view.lane(i));
                if (leaf) {
                    EXPECT_EQ(view.lane(i), boxes[view.ref[i]]);
                    EXPECT_FALSE(seen[view.ref[i]]);
                    seen[view.ref[i]] = true;
                } else {
                    open.push_back({view.ref[i], view.lane(i)});
                }
            }
            EXPECT_EQ(bounds, top.bounds);
        }
        EXPECT_EQ(std::ranges::count(seen, true), static_cast<std::ptrdiff_t>(n));
    }
}

TEST(PackedPairs, AgreeWithBruteForceInAnyOrderOnEveryInstructionSet) {
    on_every_target([&] {
        for (const BoxFamily& family : box_families()) {
            SCOPED_TRACE(family.name);
            const std::vector<Pair> expected = brute_force(family.boxes);
            for (const PackedLayout& layout :
                 {in_curve_order(family.boxes),
                  PackedLayout::of_order(family.boxes, shuffled(family.boxes.size()), serial())}) {
                std::vector<Pair> pairs;
                AppendPairs sink(pairs);
                self_pairs(layout, serial(), sink);
                std::ranges::sort(pairs);
                ASSERT_EQ(pairs, expected);
            }
        }
    });
}

TEST(PackedPairs, MeetTreesOfAnyTwoHeights) {
    for (const std::size_t n : {1u, 16u, 17u, 256u, 257u, 5000u})
        for (const std::size_t m : {1u, 17u, 300u, 5000u}) {
            SCOPED_TRACE(std::to_string(n) + " against " + std::to_string(m));
            const std::vector<Box> a = random_boxes(n, .1f, 5), b = random_boxes(m, .1f, 6);
            std::vector<Pair> first;
            for (const unsigned threads : {1u, 2u, 4u}) {
                std::vector<Pair> pairs;
                AppendPairs sink(pairs);
                tree_pairs(in_curve_order(a), in_curve_order(b), *make_executor("tbb", threads),
                           sink);
                if (threads == 1)
                    first = pairs;
                EXPECT_EQ(pairs, first);
            }
            CountPairs count;
            EXPECT_EQ(tree_pairs_counted(in_curve_order(a), in_curve_order(b), count).answers,
                      first.size());
            std::ranges::sort(first);
            ASSERT_EQ(first, brute_force(a, b));
        }
}

TEST(PackedPairs, ComeInTheSameOrderOnAnyNumberOfThreads) {
    const std::vector<Box> boxes = random_boxes(30000, .05f, 3);
    const PackedLayout layout = in_curve_order(boxes);
    std::vector<Pair> expected;
    AppendPairs serially(expected);
    self_pairs(layout, serial(), serially);
    EXPECT_GT(expected.size(), 30000u);
    for (const std::string_view name : {"openmp", "tbb"})
        for (const unsigned threads : {2u, 4u}) {
            std::vector<Pair> pairs;
            AppendPairs sink(pairs);
            for (int again = 0; again < 3; ++again) {
                pairs.clear();
                self_pairs(layout, *make_executor(name, threads), sink);
                EXPECT_EQ(pairs, expected);
            }
        }
}

} // namespace
} // namespace boxwood
