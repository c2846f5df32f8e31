#include "kernels/testing/every_target.h"
#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/queries/sinks.h"
#include "trees/testing/box_families.h"
#include "trees/testing/each_builder.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/layouts_answering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

namespace boxwood {
namespace {

void for_all_layouts(const std::function<void(const LayoutEntry&)>& test) {
    for (const LayoutEntry& layout : layouts_answering({Query::self_pairs, Query::tree_pairs})) {
        SCOPED_TRACE(layout.name);
        test(layout);
    }
}

TEST_P(EachBuilder, SelfPairsAgreeWithBruteForceOnEveryFamilyLayoutAndExecutor) {
    for (const BoxFamily& family : box_families()) {
        SCOPED_TRACE(family.name);
        const std::vector<Pair> expected = brute_force(family.boxes);
        const Tree tree = build(family.boxes);
        for_all_layouts([&](const LayoutEntry& entry) {
            const auto layout = entry.make(tree, serial());
            std::vector<Pair> first;
            for (const auto& [name, executor] : every_executor()) {
                SCOPED_TRACE(name);
                std::vector<Pair> pairs;
                AppendPairs sink(pairs);
                layout->self_pairs(*executor, sink);
                if (first.empty())
                    first = pairs;
                EXPECT_EQ(pairs, first) << "the order depends on the executor";
                std::ranges::sort(pairs);
                ASSERT_EQ(pairs, expected);
            }
            CountPairs count;
            const Work work = layout->self_pairs_counted(count);
            EXPECT_EQ(count.count(), expected.size());
            EXPECT_EQ(work.answers, expected.size());
        });
    }
}

TEST_P(EachBuilder, TreePairsAgreeWithBruteForceOnEveryFamilyLayoutAndExecutor) {
    const std::vector<BoxFamily> all = box_families();
    for (std::size_t f = 0; f < all.size(); ++f) {
        const Boxes a = all[f].boxes, b = all[(f + 1) % all.size()].boxes;
        SCOPED_TRACE(all[f].name);
        std::vector<Pair> expected;
        for (std::uint32_t i = 0; i < a.size(); ++i)
            for (std::uint32_t j = 0; j < b.size(); ++j)
                if (overlaps(a[i], b[j]))
                    expected.push_back({i, j});
        const Tree tree_a = build(a), tree_b = build(b);
        for_all_layouts([&](const LayoutEntry& entry) {
            const auto layout_a = entry.make(tree_a, serial());
            const auto layout_b = entry.make(tree_b, serial());
            std::vector<Pair> first;
            for (const ExecutorEntry& executor : executors()) {
                std::vector<Pair> pairs;
                AppendPairs sink(pairs);
                layout_a->tree_pairs(*layout_b, *executor.make(std::min(3u, executor.max_threads)),
                                     sink);
                if (first.empty())
                    first = pairs;
                EXPECT_EQ(pairs, first);
                std::ranges::sort(pairs);
                ASSERT_EQ(pairs, expected) << executor.name;
            }
            CountPairs count;
            EXPECT_EQ(layout_a->tree_pairs_counted(*layout_b, count).answers, expected.size());
            EXPECT_EQ(count.count(), expected.size());
        });
    }
}

TEST(SelfPairs, AgreeOnEveryInstructionSet) {
    const std::vector<Box> boxes = random_boxes(6000, .1f, 12);
    const Tree tree = find_builder("binned_sah").make({})(boxes, serial());
    const std::vector<Pair> expected = brute_force(boxes);
    std::vector<Pair> expected_halves;
    for (const Pair p : expected)
        if (p.a < 3000 && p.b >= 3000)
            expected_halves.push_back({p.a, p.b - 3000});
    const Tree half_a = find_builder("median").make({})({boxes.data(), 3000}, serial());
    const Tree half_b = find_builder("binned_sah").make({})({boxes.data() + 3000, 3000}, serial());
    on_every_target([&] {
        for (const LayoutEntry& entry : layouts_answering({Query::self_pairs, Query::tree_pairs})) {
            SCOPED_TRACE(entry.name);
            std::vector<Pair> pairs, halves;
            AppendPairs sink(pairs), sink_halves(halves);
            entry.make(tree, serial())->self_pairs(serial(), sink);
            entry.make(half_a, serial())
                ->tree_pairs(*entry.make(half_b, serial()), serial(), sink_halves);
            std::ranges::sort(pairs);
            std::ranges::sort(halves);
            EXPECT_EQ(pairs, expected);
            EXPECT_EQ(halves, expected_halves);
        }
    });
}

TEST(TreePairs, RefuseTwoLayouts) {
    const std::vector<Box> boxes = random_boxes(10, .1f, 1);
    const Tree tree = find_builder("median").make({})(boxes, serial());
    std::vector<Pair> pairs;
    AppendPairs sink(pairs);
    EXPECT_THROW(find_layout("binary")
                     .make(tree, serial())
                     ->tree_pairs(*find_layout("wide8").make(tree, serial()), serial(), sink),
                 std::invalid_argument);
}

TEST_P(EachBuilder, EarlyExitStopsTheTraversal) {
    const std::vector<Box> boxes(500, Box{{0, 0, 0}, {1, 1, 1}});
    const Tree tree = build(boxes);
    for_all_layouts([&](const LayoutEntry& entry) {
        const auto layout = entry.make(tree, serial());
        std::size_t seen = 0;
        ForEachPair sink([&](Pair) { return ++seen < 10; });
        layout->self_pairs(serial(), sink);
        EXPECT_EQ(seen, 10u);
    });
}

TEST_P(EachBuilder, SelfPairsOfIdenticalBoxesAreTheWorkOfTheOutput) {
    const std::vector<Box> boxes(4000, Box{{0, 0, 0}, {1, 1, 1}});
    const Tree tree = build(boxes);
    for_all_layouts([&](const LayoutEntry& entry) {
        const auto layout = entry.make(tree, serial());
        CountPairs count;
        const Work work = layout->self_pairs_counted(count);
        EXPECT_EQ(count.count(), 4000u * 3999 / 2);
        EXPECT_LT(work.box_tests, 5 * count.count());
    });
}

TEST(SelfPairs, TraverseATreeThatIsAChain) {
    constexpr std::uint32_t n = 30000;
    Tree tree(n);
    for (std::uint32_t k = 0; k < n; ++k) {
        const auto x = static_cast<float>(k);
        tree.order[k] = k;
        if (k + 1 < n)
            tree.nodes[2 * k] = {{{x, 0, 0}, {static_cast<float>(n), 1, 1}}, k, n - k};
        tree.nodes[k + 1 < n ? 2 * k + 1 : 2 * k] = {{{x, 0, 0}, {x + 1, 1, 1}}, k, 1};
    }
    for (const LayoutEntry& entry : layouts_answering({Query::self_pairs, Query::tree_pairs})) {
        SCOPED_TRACE(entry.name);
        const auto layout = entry.make(tree, serial());
        CountPairs serial_count, count;
        layout->self_pairs(serial(), serial_count);
        layout->self_pairs(*make_executor("tbb", 3), count);
        EXPECT_EQ(serial_count.count(), n - 1);
        EXPECT_EQ(count.count(), n - 1);
        layout->tree_pairs(*layout, serial(), count);
        EXPECT_EQ(count.count(), n + 2 * (n - 1));
    }
}

TEST_P(EachBuilder, RefusesBadBoxesByIndex) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float inf = std::numeric_limits<float>::infinity();
    for (const Box& bad :
         {Box{{nan, 0, 0}, {1, 1, 1}}, Box{{0, 0, 0}, {1, nan, 1}}, Box{{0, 0, -inf}, {1, 1, 1}},
          Box{{0, 0, 0}, {1, 1, inf}}, Box{{0, 2, 0}, {1, 1, 1}}, Box{}}) {
        std::vector<Box> boxes = random_boxes(20, .1f, 1);
        boxes[13] = bad;
        try {
            build(boxes);
            FAIL() << "took a bad box";
        } catch (const InvalidBox& error) {
            EXPECT_EQ(error.index, 13u);
        }
    }
}

TEST(Builders, SettingsAreChecked) {
    const BuilderEntry& builder = find_builder("binned_sah");
    EXPECT_THROW(builder.make({{"bin", 8}}), std::invalid_argument);
    EXPECT_THROW(builder.make({{"bins", 1}}), std::invalid_argument);
    const std::vector<Box> boxes = random_boxes(100, .1f, 1);
    EXPECT_EQ(builder.make({{"bins", 4}})(boxes, serial()).size(), 100u);
}

TEST(Executors, RethrowAndCountEveryIndexOnce) {
    for (const ExecutorEntry& entry : executors()) {
        const auto executor = entry.make(std::min(3u, entry.max_threads));
        std::vector<int> seen(1000, 0);
        executor->for_each(seen.size(), [&](std::size_t i) { ++seen[i]; });
        EXPECT_EQ(std::ranges::count(seen, 1), 1000) << entry.name;
        EXPECT_THROW(executor->for_each(100,
                                        [](std::size_t i) {
                                            if (i == 57)
                                                throw std::runtime_error("57");
                                        }),
                     std::runtime_error);
    }
    EXPECT_THROW(make_executor("serial", 2), std::invalid_argument);
    EXPECT_THROW(make_executor("tbb", 0), std::invalid_argument);
    EXPECT_THROW(make_executor("cuda", 1), std::invalid_argument);
}

} // namespace
} // namespace boxwood
