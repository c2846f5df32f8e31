#include "bench/machine/environment.h"

#include "bench/machine/machine.h"
#include "bench/tasks/instruction_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

namespace boxwood::bench {
namespace {

TEST(Environment, SaysWhatItCan) {
    const results::Env env = environment(false);
    EXPECT_EQ(env.env_hash.size(), 16u);
    EXPECT_FALSE(env.host.empty() || env.cpu.empty() || env.kernel.empty() || env.compiler.empty());
    EXPECT_GE(env.ncpu, 1u);
    EXPECT_NE(env.flags.find("-ffp-contract=off"), std::string::npos);
    EXPECT_TRUE(std::isnan(env.stream_triad_gbs_1));
    for (const results::Package& package : package_rows())
        EXPECT_EQ(package.present != 0, !package.version.empty()) << package.library;
    EXPECT_EQ(std::ranges::count(package_rows(), "hdf5", &results::Package::library), 1);
    // Where a Debian package is installed its revision begins with the version, and says it once.
    for (const results::Package& package : package_rows())
        if (package.library == "fmt" && !package.revision.empty()) {
            EXPECT_EQ(package.revision.find(package.version), 0u) << package.revision;
            EXPECT_EQ(package.revision.find(package.version, 1), std::string::npos);
        }
}

TEST(Environment, BandwidthIsPlausibleAndNoPartOfTheHash) {
    const results::Env env = environment(true);
    EXPECT_GT(env.stream_triad_gbs_1, 0.1);
    EXPECT_LT(env.stream_triad_gbs_1, 10'000);
    EXPECT_GT(env.stream_triad_gbs_all, 0.1);
    EXPECT_GT(env.core_ghz, 0.3);
    EXPECT_LT(env.core_ghz, 10);
    EXPECT_EQ(env.env_hash, environment(false).env_hash);
}

TEST(Environment, TheInstructionSetInUseIsOneOfThoseSupported) {
    const auto supported = isas_supported();
    EXPECT_NE(std::find(supported.begin(), supported.end(), isa_used()), supported.end());
    EXPECT_EQ(std::find(supported.begin(), supported.end(), "Unknown"), supported.end());
}

TEST(Environment, TestsRunInIeeeArithmetic) { EXPECT_TRUE(ieee_arithmetic()); }

TEST(Environment, TheCacheTextHoldsTheBuildType) {
    EXPECT_NE(cmake_cache_text().find("CMAKE_BUILD_TYPE:STRING=" + std::string(build_type())),
              std::string::npos);
}

/// A made-up /proc and /sys.
class MachineTest : public ::testing::Test {
  protected:
    MachineTest()
        : root_(std::filesystem::temp_directory_path() /
                ("boxwood_machine_" + std::to_string(std::random_device{}()))) {}
    ~MachineTest() override { std::filesystem::remove_all(root_); }
    void put(const std::string& path, const std::string& text) {
        std::filesystem::create_directories((root_ / path).parent_path());
        std::ofstream(root_ / path) << text;
    }
    std::filesystem::path root_;
};

TEST_F(MachineTest, ReadsWhatLinuxWrites) {
    put("proc/cpuinfo", "processor\t: 0\nmodel name\t: Turtle 9\nflags\t\t: fpu hypervisor sse\n");
    put("proc/stat", "cpu  100 0 0 800 0 0 0 100 0 0\ncpu0 1 2 3\n");
    put("proc/loadavg", "1.25 0.5 0.1 1/95 9939\n");
    put("proc/meminfo", "MemTotal:        8000 kB\nMemFree: 10 kB\n");
    put("sys/fs/cgroup/cpu.max", "150000 100000\n");
    put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave\n");
    put("sys/devices/system/cpu/intel_pstate/no_turbo", "1\n");
    put("sys/devices/system/cpu/smt/active", "1\n");
    put("sys/kernel/mm/transparent_hugepage/enabled", "always [madvise] never\n");
    put("sys/devices/system/cpu/cpu0/cache/index0/level", "1\n");
    put("sys/devices/system/cpu/cpu0/cache/index0/type", "Instruction\n");
    put("sys/devices/system/cpu/cpu0/cache/index0/size", "64K\n");
    put("sys/devices/system/cpu/cpu0/cache/index1/level", "1\n");
    put("sys/devices/system/cpu/cpu0/cache/index1/type", "Data\n");
    put("sys/devices/system/cpu/cpu0/cache/index1/size", "48K\n");
    put(".dockerenv", "");
    const Machine m = read_machine("", root_);
    EXPECT_EQ(m.cpu, "Turtle 9");
    EXPECT_EQ(m.virt, "hypervisor container");
    EXPECT_DOUBLE_EQ(m.steal, 0.1);
    EXPECT_DOUBLE_EQ(m.load1, 1.25);
    EXPECT_EQ(m.memory_bytes, 8000u << 10);
    EXPECT_EQ(m.quota, 1.5);
    EXPECT_EQ(m.l1d_bytes, 48u << 10);
    EXPECT_EQ(m.governor, "powersave");
    EXPECT_EQ(m.boost, false);
    EXPECT_EQ(m.smt, true);
    EXPECT_EQ(m.thp, "madvise");
}

TEST_F(MachineTest, AnEmptySystemIsUnknownNotAnError) {
    const Machine m = read_machine("", root_);
    EXPECT_EQ(m.cpu, "unknown");
    EXPECT_EQ(m.governor, "unknown");
    EXPECT_EQ(m.virt, "none");
    EXPECT_EQ(m.boost, std::nullopt);
    EXPECT_EQ(m.smt, std::nullopt);
    EXPECT_EQ(m.quota, std::nullopt);
    EXPECT_EQ(m.steal, 0);
}

TEST_F(MachineTest, NoQuotaIsNone) {
    put("sys/fs/cgroup/cpu.max", "max 100000\n");
    put("sys/devices/system/cpu/cpufreq/boost", "1\n");
    const Machine m = read_machine("", root_);
    EXPECT_EQ(m.quota, std::nullopt);
    EXPECT_EQ(m.boost, true);
}

TEST_F(MachineTest, LscpuNamesTheHypervisorAndTheProcessor) {
    const Machine m = read_machine("Model name:      Turtle 9\nHypervisor vendor:    KVM\n", root_);
    EXPECT_EQ(m.virt, "KVM");
    EXPECT_EQ(m.cpu, "Turtle 9");
}

} // namespace
} // namespace boxwood::bench
