#include "kernels/arithmetic/float_mode.h"
#include "trees/testing/every_executor.h"

#include <gtest/gtest.h>

#include <atomic>

namespace boxwood {
namespace {

TEST(Executors, KeepDenormalsInEveryBodyAndLeaveTheCallersMode) {
    for (const bool flushing : {true, false}) // worker threads may start in the first one's mode
        for (const ExecutorToTry& executor : every_executor()) {
            const DenormalFlushing mode(flushing);
            std::atomic<int> calls = 0, flushed = 0;
            executor.run->for_each(1000, [&](std::size_t) {
                ++calls;
                flushed += flushes_denormals();
            });
            EXPECT_EQ(calls, 1000) << executor.name;
            EXPECT_EQ(flushed, 0) << executor.name;
            EXPECT_EQ(flushes_denormals(), flushing && float_mode::flushing != 0) << executor.name;
        }
}

} // namespace
} // namespace boxwood
