#include "bench/analysis/size_scaling.h"

#include "bench/analysis/status.h"
#include "bench/testing/run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boxwood::bench {
namespace {

using results::Phase;

PowerOfN power_of_run(const RunForTest& run) {
    const Times times(run.results);
    std::map<double, const Times::Rounds*> by_n;
    for (const results::Cell& cell : run.results.cells)
        by_n[static_cast<double>(cell.n_items)] = times.rounds(cell.cell_id, Phase::query);
    return power_of_n(by_n);
}

/// Times c n^p at 10^3 to 10^6; the factor of a round may depend on n.
RunForTest power(double p, const std::function<double(std::uint32_t round, double n)>& factor) {
    RunForTest run;
    for (const double n : {1e3, 1e4, 1e5, 1e6}) {
        const auto cell = run.cell("uniform", static_cast<std::uint64_t>(n), "pairs", "a.packed");
        run.time(cell, Phase::query,
                 [&](std::uint32_t round) { return 7 * std::pow(n, p) * factor(round, n); });
    }
    return run;
}

TEST(SizeScaling, FindsTheExponentThatTheTimesWereMadeWith) {
    for (const double p : {0.5, 1.0, 1.25, 2.0}) {
        // A slow round slows every size: the slopes are untouched.
        const PowerOfN fit =
            power_of_run(power(p, [](std::uint32_t round, double) { return 1 + round * 0.3; }));
        EXPECT_NEAR(fit.exponent.mid, p, 1e-12);
        EXPECT_NEAR(fit.exponent.lo, p, 1e-12);
        EXPECT_NEAR(fit.exponent.hi, p, 1e-12);
        EXPECT_EQ(fit.exponent.n, 9u);
        EXPECT_NEAR(fit.off_line, 0, 1e-12);
    }
}

TEST(SizeScaling, NoisyRoundsWidenTheIntervalAroundTheExponent) {
    // Round r has the exponent 1 + (r - 4) / 100; of nine, the interval is from rank 2 to 8.
    const PowerOfN fit = power_of_run(
        power(1, [](std::uint32_t round, double n) { return std::pow(n, (round - 4.0) / 100); }));
    EXPECT_NEAR(fit.exponent.mid, 1.00, 1e-12);
    EXPECT_NEAR(fit.exponent.lo, 0.97, 1e-12);
    EXPECT_NEAR(fit.exponent.hi, 1.03, 1e-12);
}

TEST(SizeScaling, AKinkIsSaidAsDistanceFromTheLine) {
    // Twice the time at the last of four sizes: residuals of a line through 0, 0, 0, log 2 at
    // -3, -1, 1, 3 are log 2 times 0.2, -0.1, -0.4, 0.3; the exponent grows by 0.3 log10 2.
    const PowerOfN fit =
        power_of_run(power(1, [](std::uint32_t, double n) { return n == 1e6 ? 2.0 : 1.0; }));
    EXPECT_NEAR(fit.exponent.mid, 1 + 0.3 * std::log10(2.0), 1e-12);
    EXPECT_NEAR(fit.off_line, std::pow(2.0, 0.4) - 1, 1e-12);
}

TEST(SizeScaling, OnlyRoundsWithEverySizeCount) {
    RunForTest run = power(1.5, [](std::uint32_t, double) { return 1.0; });
    std::erase_if(run.results.samples, [](const results::Sample& sample) {
        return sample.cell_id == 3 && sample.round > 5;
    });
    const PowerOfN fit = power_of_run(run);
    EXPECT_EQ(fit.exponent.n, 6u);
    EXPECT_NEAR(fit.exponent.mid, 1.5, 1e-12);
}

TEST(SizeScaling, IsOfThreeSizesOfOneSceneAndOfRightAnswersAlone) {
    RunForTest run = power(1.25, [](std::uint32_t, double) { return 1.0; });
    for (const std::uint64_t n : {1000u, 10000u})
        run.time(run.cell("clusters", n, "pairs", "b.packed"), Phase::query, 5);
    set_statuses(run.results);
    const auto rows = size_scaling_of(run.results, Times(run.results));
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].cell_id, 3u);
    EXPECT_EQ(rows[0].n_sizes, 4u);
    EXPECT_NEAR(rows[0].exponent_lo, 1.25, 1e-12);
    EXPECT_NEAR(rows[0].off_line, 0, 1e-12);
    run.results.checks[1].status = run.results.checks[2].status = results::Status::wrong;
    set_statuses(run.results);
    EXPECT_TRUE(size_scaling_of(run.results, Times(run.results)).empty());
}

} // namespace
} // namespace boxwood::bench
