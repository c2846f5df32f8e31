#include "bench/io/available_memory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <random>
#include <string>

namespace boxwood::bench {
namespace {

class AvailableMemory : public testing::Test {
  protected:
    ~AvailableMemory() override { std::filesystem::remove_all(root_); }
    void put(const std::string& file, const std::string& text) const {
        std::filesystem::create_directories((root_ / file).parent_path());
        std::ofstream(root_ / file) << text;
    }
    std::filesystem::path root_ = std::filesystem::temp_directory_path() /
                                  ("boxwood_memory_" + std::to_string(std::random_device{}()));
};

TEST_F(AvailableMemory, IsWhatTheKernelCallsAvailable) {
    EXPECT_EQ(available_memory(root_), std::numeric_limits<std::uint64_t>::max());
    put("proc/meminfo", "MemTotal:  9000 kB\nMemFree:   10 kB\nMemAvailable:   8000 kB\n");
    EXPECT_EQ(available_memory(root_), 8000u << 10);
    EXPECT_GT(available_memory(), 1u << 20);
    EXPECT_LT(available_memory(), std::uint64_t{1} << 50);
}

TEST_F(AvailableMemory, ALimitOfVersion2HoldsFromAnyGroupAbove) {
    put("proc/meminfo", "MemAvailable:   8000 kB\n");
    put("proc/self/cgroup", "0::/outer/inner\n");
    put("sys/fs/cgroup/outer/inner/memory.max", "max\n");
    put("sys/fs/cgroup/outer/inner/memory.current", "1000\n");
    EXPECT_EQ(available_memory(root_), 8000u << 10);
    put("sys/fs/cgroup/outer/memory.max", "500000\n");
    put("sys/fs/cgroup/outer/memory.current", "300000\n");
    put("sys/fs/cgroup/outer/memory.stat", "anon 200000\ninactive_file 90000\n");
    EXPECT_EQ(available_memory(root_), 290'000u); // the idle cache is given back
    put("sys/fs/cgroup/outer/inner/memory.max", "1500\n");
    EXPECT_EQ(available_memory(root_), 500u);
    put("sys/fs/cgroup/outer/inner/memory.current", "1600\n");
    EXPECT_EQ(available_memory(root_), 0u);
}

TEST_F(AvailableMemory, ALimitOfVersion1HoldsAlsoWhereThePathIsTheHosts) {
    put("proc/meminfo", "MemAvailable:   8000 kB\n");
    put("proc/self/cgroup", "9:cpu,cpuacct:/\n4:memory:/docker/abc\n0::/\n");
    put("sys/fs/cgroup/memory/memory.limit_in_bytes", "700000\n");
    put("sys/fs/cgroup/memory/memory.usage_in_bytes", "100000\n");
    put("sys/fs/cgroup/memory/memory.stat", "inactive_file 7\ntotal_inactive_file 40000\n");
    EXPECT_EQ(available_memory(root_), 640'000u);
    put("sys/fs/cgroup/memory/docker/abc/memory.limit_in_bytes", "9223372036854771712\n");
    put("sys/fs/cgroup/memory/docker/abc/memory.usage_in_bytes", "100000\n");
    EXPECT_EQ(available_memory(root_), 640'000u);
}

} // namespace
} // namespace boxwood::bench
