#include "bench/machine/quiet.h"

#include "results/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

namespace boxwood::bench {
namespace {

TEST(Quiet, TicksOfProcStat) {
    const auto ticks = cpu_ticks_of("cpu  10 20 30 400 50 6 7 8 9 10\ncpu0 1 2 3\n");
    ASSERT_TRUE(ticks);
    EXPECT_EQ(ticks->busy, 10u + 20 + 30 + 6 + 7 + 8);
    EXPECT_EQ(ticks->all, ticks->busy + 400 + 50);
    for (const char* bad : {"", "cpu", "cpu 1 2 3", "intr 1 2 3 4 5 6 7 8", "cpu a b c d e f g h"})
        EXPECT_FALSE(cpu_ticks_of(bad)) << bad;
}

TEST(Quiet, WorkOfAnotherThreadIsSeen) {
    if (std::isnan(busy_cores(std::chrono::milliseconds(50))))
        GTEST_SKIP() << "no /proc/stat here";
    std::atomic<bool> stop = false;
    std::thread other([&] {
        while (!stop)
            ;
    });
    const double cores = busy_cores(std::chrono::milliseconds(300));
    stop = true;
    other.join();
    EXPECT_GT(cores, results::quiet_cores);
}

TEST(Quiet, WaitsUntilItIsQuietButNoLongerThanItMay) {
    std::vector<double> said;
    const auto note = [&](double cores) {
        said.push_back(cores);
        return true;
    };
    std::vector<double> coming{.1, 2, 1.5}; // the last comes first
    QuietWait until_quiet(1e-3, [&] {
        const double cores = coming.back();
        coming.pop_back();
        return cores;
    });
    EXPECT_EQ(until_quiet.wait(note), 2); // one pause of all that there is
    EXPECT_THAT(said, ::testing::ElementsAre(1.5));
    EXPECT_FALSE(until_quiet.may_wait());
    EXPECT_EQ(until_quiet.wait(note), .1);
    EXPECT_EQ(said.size(), 1u);

    QuietWait never(1e3, [] { return 2.; });
    EXPECT_EQ(never.wait([](double) { return false; }), 2); // Ctrl-C
    QuietWait unknown(1e3, [] { return std::nan(""); });
    EXPECT_TRUE(std::isnan(unknown.wait(note)));
}

} // namespace
} // namespace boxwood::bench
