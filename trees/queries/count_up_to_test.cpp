#include "trees/queries/count_up_to.h"

#include "trees/builders/median.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/layouts_answering.h"

#include <gtest/gtest.h>

#include <vector>

namespace boxwood {
namespace {

TEST(CountPairsUpTo, StopsTheTraversalAboveTheLimitAndNowhereElse) {
    constexpr std::uint64_t n = 4500, all = n * (n - 1) / 2;
    const std::vector<Box> boxes(n, Box{{0, 0, 0}, {1, 1, 1}});
    const Tree tree = MedianBuilder().build(boxes, serial());
    for (const LayoutEntry& entry : layouts_answering({Query::self_pairs})) {
        const auto layout = entry.make(tree, serial());
        for (const ExecutorToTry& executor : every_executor()) {
            SCOPED_TRACE(std::string(entry.name) + " " + executor.name);
            CountPairsUpTo some(20'000), enough(all);
            layout->self_pairs(*executor.run, some);
            EXPECT_GT(some.count(), 20'000u);
            EXPECT_LT(some.count(), all / 10);
            if (executor.run->threads() != 4)
                continue;
            layout->self_pairs(*executor.run, enough);
            EXPECT_EQ(enough.count(), all);
        }
    }
}

} // namespace
} // namespace boxwood
