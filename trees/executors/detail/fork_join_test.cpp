#include "trees/executor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

namespace boxwood {
namespace {

/// Two tasks that run at the same time, on two threads, and are not ordered by it. Where there is
/// but one core TBB has one thread, and the first goes on alone after a while.
template <class Body> void two_at_once(const Executor& executor, const Body& body) {
    std::atomic<int> started = 0;
    executor.for_each(2, [&](std::size_t i) {
        started.fetch_add(1, std::memory_order_relaxed);
        const auto latest = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
        while (started.load(std::memory_order_relaxed) < 2 &&
               std::chrono::steady_clock::now() < latest)
            std::this_thread::yield();
        body(i);
    });
}

TEST(ForkJoin, TasksSeeWhatCameBeforeAndAreSeenAfter) {
    for (const ExecutorEntry& entry : executors()) {
        if (entry.max_threads == 1)
            continue;
        const auto executor = entry.make(2);
        std::vector<int> sums(2);
        for (int round = 0; round < 100; ++round) {
            std::vector<int> plain(2, round);
            two_at_once(*executor, [&](std::size_t i) { sums[i] += plain[1 - i]; });
            EXPECT_EQ(sums[0], sums[1]);
        }
        EXPECT_EQ(sums[0], 99 * 100 / 2);
    }
}

#ifdef __SANITIZE_THREAD__
/// The check can fail: what two tasks do to one number without order is still seen.
TEST(ForkJoinDeathTest, ThreadSanitizerSeesARaceBetweenTasks) {
    GTEST_FLAG_SET(death_test_style, "threadsafe"); // fork alone is not enough with threads about
    for (const ExecutorEntry& entry : executors()) {
        if (entry.max_threads == 1)
            continue;
        EXPECT_EXIT(
            {
                int sum = 0;
                two_at_once(*entry.make(2), [&](std::size_t i) { sum += static_cast<int>(i); });
                std::exit(sum < 0);
            },
            testing::ExitedWithCode(66), "ThreadSanitizer: data race")
            << entry.name;
    }
}
#endif

} // namespace
} // namespace boxwood
