/// run_child starts this executable again, so the child here is the test DISABLED_Victim.

#include "bench/running/child.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

std::vector<std::string> own_arguments() {
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::vector<std::string> arguments;
    for (std::string argument; std::getline(file, argument, '\0');)
        arguments.push_back(argument);
    return arguments;
}

struct ChildRun {
    ChildEnd end;
    std::vector<std::string> reported;
};

ChildRun run(const std::string& fate) {
    ChildRun result;
    Interrupt interrupt;
    result.end = run_child(
        {"victim", "--gtest_filter=Child.DISABLED_Victim", "--gtest_also_run_disabled_tests",
         "--gtest_catch_exceptions=0", "--gtest_brief=1", "--fate", fate},
        2, 48, interrupt, [&](std::size_t done, std::size_t total, const std::string& cell) {
            result.reported.push_back(std::to_string(done) + "/" + std::to_string(total) + " " +
                                      cell);
            if (fate == "waits")
                raise(SIGINT);
        });
    return result;
}

TEST(Child, DISABLED_Victim) {
    const std::vector<std::string> arguments = own_arguments();
    ASSERT_GE(arguments.size(), 9u);
    const std::string fate = arguments[6];
    ChildReport report(std::stoi(arguments.back()));
    if (fate != "early")
        report.at(3, 7, "scene/cell");
    if (fate == "segfaults" || fate == "early") {
        std::signal(SIGSEGV, SIG_DFL);
        raise(SIGSEGV);
    }
    if (fate == "exits")
        std::_Exit(5);
    if (fate == "throws") {
        report.threw(std::runtime_error("no\nmemory"));
        std::_Exit(1);
    }
    if (fate == "fails") {
        report.finishing();
        report.failed(std::runtime_error("the disk is full"));
        std::_Exit(2);
    }
    if (fate == "waits")
        pause();
    const char* policy = std::getenv("OMP_WAIT_POLICY");
    const char* threads = std::getenv("OMP_NUM_THREADS");
    const char* malloc_settings = std::getenv("GLIBC_TUNABLES");
    if (own_padding() != 48 || !malloc_settings ||
        std::string(malloc_settings) != "glibc.malloc.hugetlb=1")
        std::_Exit(8);
    if (!policy || std::string(policy) != "passive" || !threads || std::string(threads) != "2" ||
        std::getenv("BENCHMARK_FILTER"))
        std::_Exit(9);
    std::_Exit(0);
}

TEST(Child, ThatEndsWellHasAnEnvironmentFitForTiming) {
    setenv("BENCHMARK_FILTER", "nothing", 1);
    setenv("OMP_NUM_THREADS", "64", 1);
    const ChildRun result = run("ends well");
    unsetenv("BENCHMARK_FILTER");
    unsetenv("OMP_NUM_THREADS");
    EXPECT_EQ(result.end.kind, ChildEnd::Kind::done);
    EXPECT_EQ(result.reported, std::vector<std::string>{"3/7 scene/cell"});
}

TEST(Child, ThatCrashesLeavesTheCellAndTheCause) {
    ChildEnd end = run("segfaults").end;
    EXPECT_EQ(end.kind, ChildEnd::Kind::crashed);
    EXPECT_EQ(end.cell, "scene/cell");
    EXPECT_THAT(end.cause, HasSubstr("signal 11"));
    end = run("early").end;
    EXPECT_EQ(end.kind, ChildEnd::Kind::crashed);
    EXPECT_EQ(end.cell, "");
    end = run("exits").end;
    EXPECT_EQ(end.kind, ChildEnd::Kind::crashed);
    EXPECT_EQ(end.cause, "exit code 5");
    end = run("throws").end;
    EXPECT_EQ(end.kind, ChildEnd::Kind::crashed);
    EXPECT_EQ(end.cell, "scene/cell");
    EXPECT_EQ(end.cause, "no memory");
}

TEST(Child, ThatCannotGoOnSaysWhy) {
    const ChildEnd end = run("fails").end;
    EXPECT_EQ(end.kind, ChildEnd::Kind::failed);
    EXPECT_EQ(end.cause, "the disk is full");
    EXPECT_EQ(end.cell, "");
}

TEST(Child, IsStoppedByCtrlC) { EXPECT_EQ(run("waits").end.kind, ChildEnd::Kind::interrupted); }

} // namespace
} // namespace boxwood::bench
