#include "bench/running/shards.h"

#include "bench/io/bad_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <optional>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

results::Results shard_of(unsigned round, const std::string& sweep_hash,
                          const std::string& env_hash) {
    results::Results r;
    r.sweep_hash = sweep_hash;
    r.env.push_back({});
    r.env[0].env_hash = env_hash;
    r.shards.push_back({});
    r.shards[0].round = round;
    return r;
}

struct ShardsTest : testing::Test {
    fs::path folder;
    void SetUp() override {
        std::string name = fs::temp_directory_path() / "boxwood-shards-XXXXXX";
        ASSERT_TRUE(mkdtemp(name.data()));
        folder = name;
    }
    void TearDown() override { fs::remove_all(folder); }
    fs::path out() const { return folder / "out.h5"; }
};

TEST_F(ShardsTest, KeepWhatIsWholeAndTheirOwn) {
    Shards shards(out(), "sweep", "machine");
    EXPECT_TRUE(shards.rounds().empty());
    shards.open();
    shards.open(); // again, as after an interruption
    EXPECT_FALSE(shards.prepared());
    results::write(shards.round_file(0), shard_of(0, "sweep", "machine"));
    results::write(shards.round_file(1), shard_of(1, "another sweep", "machine"));
    results::write(shards.round_file(2), shard_of(2, "sweep", "another machine"));
    results::write(shards.round_file(3), shard_of(3, "sweep", "machine"));
    results::write(shards.prepared_file(), shard_of(0, "sweep", "machine"));
    fs::resize_file(shards.round_file(3), fs::file_size(shards.round_file(3)) / 2);
    std::ofstream(shards.folder() / "round-0004.h5.tmp-77") << "killed while writing";

    const auto rounds = shards.rounds();
    ASSERT_EQ(rounds.size(), 1u);
    EXPECT_EQ(rounds.begin()->first, 0u);
    EXPECT_TRUE(shards.prepared());
    shards.remove();
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(ShardsTest, LeaveThoseOfAnotherSweepAlone) {
    const auto opened = [&](const char* sweep) {
        auto shards = std::make_unique<Shards>(out(), sweep, "machine");
        shards->open();
        return shards;
    };
    auto one = opened("one");
    results::write(one->round_file(0), shard_of(0, "one", "machine"));
    one.reset(); // as when it is interrupted
    opened("other")->remove();
    EXPECT_EQ(opened("one")->rounds().size(), 1u);
}

TEST_F(ShardsTest, AreOfOneSweepAtATime) {
    std::optional<Shards> one(std::in_place, out(), "one", "machine");
    one->open();
    Shards other(out(), "other", "machine");
    EXPECT_THAT([&] { other.open(); },
                testing::ThrowsMessage<BadInput>(
                    testing::AllOf(HasSubstr("another sweep writes " + out().string() + ": wait"),
                                   HasSubstr("(process " + std::to_string(::getpid()) + ")"))));
    one.reset();
    EXPECT_TRUE(fs::is_empty(folder));
    other.open();
}

TEST_F(ShardsTest, NeedAFolder) {
    EXPECT_THROW(Shards(folder / "none" / "out.h5", "s", "m").open(), BadInput);
    std::ofstream(folder / "file") << "x";
    EXPECT_THROW(Shards(folder / "file" / "out.h5", "s", "m").open(), BadInput);
    EXPECT_FALSE(fs::exists(folder / "none"));
}

TEST_F(ShardsTest, AStrippedResultHasNoRounds) {
    results::Results r = shard_of(3, "s", "m");
    r.samples.emplace_back();
    r.frames.emplace_back();
    r.effects.emplace_back();
    r.compare.emplace_back();
    r.drift.emplace_back();
    r.cells.emplace_back();
    EXPECT_EQ(rounds_in(r), std::set<unsigned>{3});
    const results::Results stripped = without_rounds(r);
    EXPECT_TRUE(rounds_in(stripped).empty());
    EXPECT_TRUE(stripped.samples.empty());
    EXPECT_TRUE(stripped.frames.empty()); // they refer to shards, too
    EXPECT_TRUE(stripped.effects.empty());
    EXPECT_TRUE(stripped.compare.empty());
    EXPECT_TRUE(stripped.drift.empty());
    EXPECT_EQ(stripped.cells.size(), 1u);
    EXPECT_EQ(stripped.env.size(), 1u);
}

} // namespace
} // namespace boxwood::bench
