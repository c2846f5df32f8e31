#include "trees/builders/incremental.h"

#include "trees/inspect/validate.h"
#include "trees/testing/box_families.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood {
namespace {

TEST(Incremental, EveryFamilyGivesAWellFormedTree) {
    for (const BoxFamily& family : box_families()) {
        const Tree tree = IncrementalBuilder{}.build(family.boxes, serial());
        EXPECT_EQ(validate(tree, family.boxes).value_or(""), "") << family.name;
    }
}

TEST(Incremental, SameTreeEachTimeAndOnEveryExecutor) {
    const auto boxes = random_boxes(2000, .05f, 3);
    const Tree once = IncrementalBuilder{}.build(boxes, serial());
    for (const ExecutorEntry& entry : executors()) {
        const Tree again =
            IncrementalBuilder{}.build(boxes, *entry.make(std::min(2u, entry.max_threads)));
        EXPECT_TRUE(std::ranges::equal(once.order, again.order)) << entry.name;
    }
}

TEST(Incremental, BadBoxIsNamed) {
    auto boxes = random_boxes(10, .1f, 4);
    boxes[7].max.y = boxes[7].min.y - 1;
    EXPECT_THAT([&] { IncrementalBuilder{}.build(boxes, serial()); },
                testing::Throws<InvalidBox>(testing::Field(&InvalidBox::index, 7u)));
}

} // namespace
} // namespace boxwood
