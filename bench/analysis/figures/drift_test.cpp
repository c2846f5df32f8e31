#include "bench/analysis/figures/drift.h"

#include "bench/analysis/analyse.h"
#include "bench/testing/run.h"

#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using results::Phase;

TEST(Drift, IsTheMiddleOfARoundsQueriesOffTheirMedians) {
    RunForTest run;
    run.rounds = 3;
    run.results.shards.resize(3);
    const std::vector<std::vector<double>> off{{1, 1, 1.5}, {1, 1.2, 1.1}, {1, 1.3, 0.6}};
    for (std::uint32_t cell = 0; cell < 3; ++cell) {
        run.cell("uniform", 100, "pairs", "a" + std::to_string(cell));
        run.time(cell, Phase::query,
                 [&](std::uint32_t round) { return 100 * (cell + 1) * off[cell][round]; });
        run.time(cell, Phase::build, [](std::uint32_t round) { return round == 0 ? 900 : 1; });
    }
    for (std::uint32_t i = 0; i < 3; ++i)
        run.results.shards[i].shard_id = i;
    for (results::Sample& sample : run.results.samples)
        sample.shard_id = sample.round;
    results::Sample twin = run.results.samples[0];
    twin.wall_ns *= 50;
    twin.flags = results::aa_twin;
    run.results.samples.push_back(twin);
    run.results.samples[1].flags = results::disturbed_steal;
    analyse(run.results);
    EXPECT_NEAR(run.results.samples[2].off_median, 0.5, 1e-12); // 150 over 100
    const auto& drift = run.results.drift;
    ASSERT_EQ(drift.size(), 3u);
    EXPECT_EQ(drift[0].n, 3u);
    EXPECT_NEAR(drift[0].off_median, 0, 1e-12);             // of 0, 1/1.1 - 1 and 0
    EXPECT_NEAR(drift[1].off_median, 1.2 / 1.1 - 1, 1e-12); // of 0, this and 0.3
    EXPECT_NEAR(drift[2].off_median, 0, 1e-12);             // of 0.5, 0 and -0.4
    EXPECT_EQ(drift[1].is_farthest, 1u);
    EXPECT_EQ(drift[1].disturbed, 1u);
    EXPECT_EQ(drift[0].is_farthest + drift[2].is_farthest, 0u);
}

} // namespace
} // namespace boxwood::bench
