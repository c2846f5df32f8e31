#pragma once

#include "results/results.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

/// Whole sweeps, run by the `boxwood` program that stands one folder above the test's.
namespace boxwood::bench {

namespace fs = std::filesystem;

inline fs::path program() {
    return fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "boxwood";
}

inline std::string text_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

template <class Condition> bool wait_until(Condition condition) {
    for (int i = 0; i < 6000; ++i) {
        if (condition())
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

/// CPU time of a process in seconds; negative if it is gone or a zombie.
inline double cpu_s(pid_t pid) {
    std::istringstream stat(text_of("/proc/" + std::to_string(pid) + "/stat"));
    std::string field;
    double user = 0, system = 0;
    for (int i = 1; i <= 15 && stat >> field; ++i) {
        if (i == 3 && field == "Z")
            return -1;
        if (i == 14)
            user = std::stod(field);
        if (i == 15)
            system = std::stod(field);
    }
    return stat ? (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK)) : -1;
}

inline pid_t child_of(pid_t pid) {
    const std::string id = std::to_string(pid);
    std::istringstream children(text_of("/proc/" + id + "/task/" + id + "/children"));
    pid_t child = 0;
    children >> child;
    return child;
}

struct SweepTest : testing::Test {
    fs::path folder;
    fs::path config() const { return folder / "sweep.toml"; }
    fs::path out() const { return folder / "out.h5"; }
    fs::path log() const { return folder / "log.txt"; }

    void SetUp() override {
        if (!fs::exists(program()))
            GTEST_SKIP() << program() << " is not built";
        std::string name = fs::temp_directory_path() / "boxwood-sweep-XXXXXX";
        ASSERT_TRUE(mkdtemp(name.data()));
        folder = name;
        write_config("n = 300\nbuilders = [\"median\", \"binned_sah\"]\npeers = \"brute_force\"\n",
                     20);
    }
    void TearDown() override {
        if (!folder.empty())
            fs::remove_all(folder);
    }

    void write_config(const std::string& block, int min_time_ms) const {
        std::ofstream(config()) << "rounds = 3\nmin_time_ms = " << min_time_ms
                                << "\n[[cells]]\nscene = \"uniform\"\ntask = \"pairs\"\n"
                                << block;
    }

    pid_t start(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"boxwood", "sweep", "--config", config(), "--out", out()};
        words.insert(words.end(), more.begin(), more.end());
        std::vector<char*> pointers;
        for (std::string& word : words)
            pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const pid_t pid = fork();
        if (pid == 0) {
            const int file = open(log().c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
            dup2(file, 1);
            dup2(file, 2);
            execv(program().c_str(), pointers.data());
            _exit(127);
        }
        return pid;
    }

    static int wait_for(pid_t pid) {
        int status = 0;
        waitpid(pid, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }
    int sweep(const std::vector<std::string>& more = {}) const { return wait_for(start(more)); }

    /// The shard files there are, by round.
    std::map<unsigned, fs::path> shard_files() const {
        std::map<unsigned, fs::path> files;
        std::error_code error;
        for (const auto& entry :
             fs::recursive_directory_iterator(out().string() + ".shards", error)) {
            unsigned round = 0;
            char end = 0;
            const std::string name = entry.path().filename();
            if (std::sscanf(name.c_str(), "round-%u.h%c", &round, &end) == 2 &&
                name.ends_with(".h5"))
                files[round] = entry.path();
        }
        return files;
    }

    /// Which process measured which round.
    static std::map<unsigned, unsigned> pids(const results::Results& results) {
        std::map<unsigned, unsigned> by_round;
        for (const results::Shard& shard : results.shards)
            EXPECT_TRUE(by_round.emplace(shard.round, shard.pid).second) << "a round twice";
        return by_round;
    }
    std::map<unsigned, unsigned> pids_of_shards() const {
        std::map<unsigned, unsigned> by_round;
        for (const auto& [round, file] : shard_files())
            by_round[round] = pids(results::read(file)).at(round);
        return by_round;
    }
};

} // namespace boxwood::bench
