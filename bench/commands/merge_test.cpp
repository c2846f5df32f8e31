#include "bench/commands/command.h"
#include "results/results.h"

#include <CLI/CLI.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

class MergeCommand : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("boxwood_merge_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string file(const std::string& name) const { return (folder_ / name).string(); }
    void make(const std::string& name, std::uint32_t round) const {
        results::Results results;
        results.env.resize(1);
        results.shards.resize(1);
        results.shards[0].round = round;
        results::write(file(name), results);
    }
    static std::string run(std::vector<std::string> arguments) {
        CLI::App app;
        int exit_code = 0;
        add_merge(app, exit_code);
        std::ranges::reverse(arguments); // as CLI11 takes them
        testing::internal::CaptureStdout();
        std::string said;
        try {
            app.parse(arguments);
        } catch (const std::exception& error) {
            said = error.what();
        }
        return testing::internal::GetCapturedStdout() + said;
    }
    fs::path folder_;
};

TEST_F(MergeCommand, JoinsFiles) {
    make("a.h5", 0);
    make("b.h5", 1);
    EXPECT_THAT(run({"merge", file("a.h5"), file("b.h5"), file("a.h5"), "--out", file("c.h5")}),
                testing::HasSubstr("machine states 1, shards 2"));
    EXPECT_EQ(results::read(file("c.h5")).shards.size(), 2u);
}

TEST_F(MergeCommand, NamesTheFilesThatDisagree) {
    make("a.h5", 0);
    results::Results changed = results::read(file("a.h5"));
    changed.cells.resize(1);
    changed.scenes.resize(1);
    changed.variants.resize(1);
    changed.samples.resize(1);
    results::write(file("b.h5"), changed);
    EXPECT_THAT(run({"merge", file("a.h5"), file("b.h5"), "--out", file("c.h5")}),
                testing::HasSubstr(file("a.h5") + " and " + file("b.h5") + " hold the same shard"));
    EXPECT_FALSE(fs::exists(file("c.h5")));
}

TEST_F(MergeCommand, KeepsItsInputs) {
    make("a.h5", 0);
    fs::create_symlink(file("a.h5"), file("link.h5"));
    for (const char* out : {"a.h5", "link.h5"})
        EXPECT_THAT(run({"merge", file("a.h5"), "--out", file(out)}),
                    testing::HasSubstr("is an input and the output"));
    EXPECT_EQ(results::read(file("a.h5")).shards.size(), 1u);
}

TEST_F(MergeCommand, MissingAndUnwritableFiles) {
    make("a.h5", 0);
    EXPECT_THAT(run({"merge", file("a.h5"), file("none.h5"), "--out", file("c.h5")}),
                testing::HasSubstr("none.h5': no such file"));
    EXPECT_FALSE(fs::exists(file("c.h5")));
    EXPECT_THAT(run({"merge", file("a.h5"), "--out", file("none/c.h5")}),
                testing::HasSubstr("does not exist"));
    EXPECT_THAT(run({"merge", file("a.h5")}), testing::HasSubstr("--out"));
}

} // namespace
} // namespace boxwood::bench
