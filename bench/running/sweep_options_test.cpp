#include "bench/io/bad_input.h"
#include "bench/running/instructions/count.h"
#include "bench/running/sweep_fixture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;

using SweepOptionsTest = SweepTest;

TEST_F(SweepOptionsTest, ABudgetAddsRoundsAndTakesThemAway) {
    write_config("n = 100\nbuilders = \"median\"\npeers = \"brute_force\"\n", 1);
    ASSERT_EQ(sweep({"--budget", "2s"}), 0) << text_of(log());
    EXPECT_GT(pids(results::read(out())).size(), 3u); // three leave comparisons open
    EXPECT_THAT(text_of(log()),
                testing::AnyOf(HasSubstr("has its verdict"), HasSubstr("the budget is spent; ")));
    fs::remove(out());
    ASSERT_EQ(sweep({"--rounds", "12", "--budget", "0.001s"}), 0) << text_of(log());
    EXPECT_EQ(pids(results::read(out())).size(), 9u);
    for (const char* bad : {"10", "-1s", "0min", "1day"})
        EXPECT_EQ(sweep({"--budget", bad}), 2) << bad;
}

TEST_F(SweepOptionsTest, ACellThatHangsIsLeftOut) {
    write_config("n = 300\nbuilders = \"median\"\nlayouts = \"packed\"\n",
                 7000); // a sample takes 7 s
    EXPECT_EQ(sweep({"--give-up", "4s"}), 1);
    EXPECT_THAT(text_of(log()), HasSubstr("the preparation stood still in uniform/n300-s1/pairs/"));
    EXPECT_THAT(text_of(log()), HasSubstr("no sign of life for 4 s; that cell is left out from "
                                          "here on"));
    const results::Results got = results::read(out());
    ASSERT_EQ(got.checks.size(), 1u);
    EXPECT_EQ(got.checks[0].status, results::Status::wrong);
    EXPECT_EQ(got.checks[0].witness, "crashed: no sign of life for 4 s in the preparation");
    EXPECT_TRUE(got.samples.empty());
}

TEST_F(SweepOptionsTest, PaddingIsDrawnByRound) {
    ASSERT_EQ(sweep(), 0) << text_of(log());
    std::set<std::uint64_t> paddings;
    for (const results::Shard& shard : results::read(out()).shards)
        paddings.insert(shard.padding_bytes);
    EXPECT_EQ(paddings.size(), 3u);
    EXPECT_LT(*paddings.rbegin(), 4096u);
}

TEST_F(SweepOptionsTest, ColdBuildsAreThoseOfFreshProcesses) {
    using results::Phase;
    write_config("n = 3000\nbuilders = \"median\"\npeers = \"brute_force\"\ncold_build = true\n",
                 2);
    ASSERT_EQ(sweep(), 0) << text_of(log());
    const results::Results got = results::read(out());
    std::map<Phase, std::vector<double>> ns;
    for (const results::Sample& sample : got.samples)
        if (sample.cell_id == 0) {
            ns[sample.phase].push_back(sample.wall_ns);
            EXPECT_EQ(sample.flags & results::wrong_answer, 0u);
        }
    const std::vector<double>& builds = ns[Phase::cold_build];
    const std::vector<double>& both = ns[Phase::cold_build_and_query];
    EXPECT_EQ(builds.size(), ns[Phase::build].size()); // one process a round
    ASSERT_GE(builds.size(), 2u);
    ASSERT_EQ(builds.size(), both.size());
    for (std::size_t i = 0; i < builds.size(); ++i) {
        EXPECT_GT(builds[i], 0);
        EXPECT_GT(both[i], builds[i]); // of one process: the query comes after the build
    }
    EXPECT_TRUE(std::ranges::any_of(got.compare, [](const results::Comparison& row) {
        return row.phase == Phase::cold_build_and_query && row.family == results::Family::peers;
    }));
}

TEST_F(SweepOptionsTest, QueriesWithColdCachesAreDearer) {
    using results::Phase;
    std::ofstream(config()) << "rounds = 3\nmin_time_ms = 2\n[[cells]]\nscene = \"sphere_mesh\"\n"
                               "task = \"collide\"\nposes = \"near\"\nn = 20000\n"
                               "builders = \"binned_sah\"\ncold_caches = true\n";
    ASSERT_EQ(sweep(), 0) << text_of(log());
    const results::Results got = results::read(out());
    std::map<Phase, double> least_ns;
    for (const results::Sample& sample : got.samples) {
        EXPECT_EQ(sample.flags & results::wrong_answer, 0u);
        const auto [least, is_new] = least_ns.try_emplace(sample.phase, sample.wall_ns);
        least->second = std::min(least->second, sample.wall_ns);
    }
    ASSERT_TRUE(least_ns.contains(Phase::cold_query));
    EXPECT_GT(least_ns[Phase::cold_query], 1.2 * least_ns[Phase::query]);
}

TEST_F(SweepOptionsTest, CountsTheSameInstructionsTwice) {
    try {
        under_callgrind(folder / "dumps");
    } catch (const BadInput& missing) {
        GTEST_SKIP() << missing.what();
    }
    write_config("n = 300\nbuilders = \"median\"\npeers = \"brute_force\"\n", 1);
    std::map<std::string, std::uint64_t> earlier;
    for (int run = 0; run < 2; ++run) {
        fs::remove(out());
        ASSERT_EQ(sweep({"--count"}), 0) << text_of(log());
        const results::Results r = results::read(out());
        EXPECT_TRUE(r.samples.empty());
        EXPECT_THAT(r.texts.at("instructions_by"), HasSubstr("valgrind"));
        std::map<std::string, std::uint64_t> counts;
        for (const results::Counter& row : r.counters)
            if (row.counter.starts_with("instructions_"))
                counts[r.cells.at(row.cell_id).name + " " + row.counter] = row.value;
        ASSERT_EQ(counts.size(), 2u); // build and query of ours
        for (const auto& [name, count] : counts) {
            EXPECT_GT(count, 10'000u) << name; // at least one per item and level
            if (run > 0) {
                const auto before = static_cast<double>(earlier[name]);
                EXPECT_NEAR(static_cast<double>(count), before, 1e-3 * before) << name;
            }
        }
        earlier = counts;
    }
    EXPECT_EQ(sweep({"--count"}), 2); // OUT is there
    EXPECT_FALSE(fs::exists(out().string() + ".shards"));
}

} // namespace
} // namespace boxwood::bench
