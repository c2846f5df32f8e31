#include "trees/builder.h"
#include "trees/inspect/validate.h"
#include "trees/layout.h"
#include "trees/queries/sinks.h"
#include "trees/testing/brute_force.h"
#include "trees/testing/each_builder.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/same_tree.h"
#include "trees/testing/ways_to_build.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

/// What holds for any boxes, every builder, optimizer, layout and executor. RapidCheck prints the
/// boxes that a failure shrinks to, and the RC_PARAMS that bring it back.
namespace boxwood {
namespace {

/// Boxes on a coarse lattice, so that many corners, centres and whole boxes are equal, flat ones
/// and points among them; some larger or smaller by a power of two from denormal to huge.
rc::Gen<std::vector<Box>> any_boxes() {
    const auto scale =
        rc::gen::weightedElement<int>({{12, 0}, {2, 1}, {1, -20}, {1, 20}, {1, -145}, {1, 124}});
    const auto box = rc::gen::map(
        rc::gen::pair(rc::gen::container<std::vector<int>>(6, rc::gen::inRange(-4, 5)), scale),
        [](const std::pair<std::vector<int>, int>& of) {
            const auto at = [&](std::size_t i) {
                return std::ldexp(static_cast<float>(of.first[i]), of.second);
            };
            Box b;
            b.extend(Vec3<float>{at(0), at(1), at(2)});
            b.extend(Vec3<float>{at(3), at(4), at(5)});
            return b;
        });
    return rc::gen::withSize([box](int size) {
        return rc::gen::resize(3 * size, rc::gen::container<std::vector<Box>>(box));
    });
}

/// One of those kept from case to case.
const Executor& any_executor() {
    static const std::vector<ExecutorToTry> all = every_executor();
    return *all[*rc::gen::inRange<std::size_t>(0, all.size())].run;
}

TEST_P(EachBuilder, MakesOneValidTreeOfAnyBoxes) {
    EXPECT_TRUE(rc::check([&] {
        const std::vector<Box> boxes = *any_boxes();
        const Executor& executor = any_executor();
        for (const std::string& way : ways_to_build(builder_)) {
            const BuildFunction build_so = make_builder(way);
            const Tree tree = build_so(boxes, serial());
            if (const auto fault = validate(tree, boxes))
                RC_FAIL(way + ": " + *fault);
            if (!same_tree(build_so(boxes, executor), tree))
                RC_FAIL(way + ": another tree on " + std::to_string(executor.threads()) +
                        " threads");
        }
    }));
}

RC_GTEST_PROP(Properties, EveryLayoutOfAnyTreeFindsThePairs, ()) {
    const std::vector<Box> boxes = *any_boxes();
    const std::vector<Pair> expected = brute_force(boxes);
    const Executor& executor = any_executor();
    const std::string way = *rc::gen::elementOf(ways_to_build());
    const BuildFunction build = make_builder(way);
    for (const LayoutEntry& entry : layouts_answering({Query::self_pairs})) {
        Tree tree;
        const auto layout = make_layout(entry, build, boxes, executor, tree);
        std::vector<Pair> pairs;
        AppendPairs sink(pairs);
        layout->self_pairs(executor, sink);
        std::ranges::sort(pairs);
        if (pairs != expected)
            RC_FAIL(way + "." + std::string(entry.name) + ": " + std::to_string(pairs.size()) +
                    " pairs, not " + std::to_string(expected.size()) + " or not the same");
    }
}

RC_GTEST_PROP(Properties, EveryLayoutOfAnyTreeFindsWhatRegionsMeet, ()) {
    const std::vector<Box> boxes = *any_boxes(), regions = *any_boxes();
    std::vector<Pair> expected;
    for (std::uint32_t r = 0; r < regions.size(); ++r)
        for (std::uint32_t i = 0; i < boxes.size(); ++i)
            if (overlaps(regions[r], boxes[i]))
                expected.push_back({r, i});
    const std::string way = *rc::gen::elementOf(ways_to_build());
    const Tree tree = make_builder(way)(boxes, serial());
    for (const LayoutEntry& entry : layouts_answering({Query::regions})) {
        std::vector<Pair> found;
        AppendPairs sink(found);
        entry.make(tree, serial())->regions(regions, serial(), sink);
        if (found != expected)
            RC_FAIL(way + "." + std::string(entry.name) + ": " + std::to_string(found.size()) +
                    " items, not " + std::to_string(expected.size()) + " or not the same");
    }
}

/// Large enough for builders to share out their work.
TEST_P(EachBuilder, MakesTheSameTreeOfManyBoxesOnEveryExecutor) {
    for (const std::uint32_t seed : {1u, 2u}) {
        std::mt19937 random(seed);
        // Odd: on a lattice, with many equal centres.
        std::uniform_real_distribution<float> place(0, seed % 2 ? 20.f : 1.f);
        std::vector<Box> boxes(6000);
        for (Box& box : boxes) {
            box.min = {place(random), place(random), place(random)};
            if (seed % 2)
                for (int k = 0; k < 3; ++k)
                    box.min[k] = std::floor(box.min[k]);
            box.max = box.min + Vec3<float>{.02f, .01f, 0};
        }
        for (const std::string& way : ways_to_build(builder_)) {
            const BuildFunction build_so = make_builder(way);
            const Tree tree = build_so(boxes, serial());
            EXPECT_EQ(validate(tree, boxes).value_or(""), "") << way;
            for (const auto& [name, executor] : parallel_executors())
                EXPECT_TRUE(same_tree(build_so(boxes, *executor), tree))
                    << way << ", " << name << " threads, seed " << seed;
        }
    }
}

} // namespace
} // namespace boxwood
