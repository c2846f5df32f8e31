#include "bench/analysis/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace boxwood::bench {
namespace {

/// The chance that the median lies between the k-th lowest and the k-th highest of n, by counting
/// subsets in integers.
double coverage(std::size_t k, std::size_t n) {
    std::uint64_t outside = 0, choose = 1; // n over i
    for (std::size_t i = 0; i < k; ++i) {
        outside += choose;
        choose = choose * (n - i) / (i + 1);
    }
    return 1 - std::ldexp(2.0 * static_cast<double>(outside), -static_cast<int>(n));
}

TEST(MedianRanks, AreTheKnownOnes) {
    EXPECT_EQ(median_ranks(6), (Ranks{1, 6}));
    EXPECT_EQ(median_ranks(9), (Ranks{2, 8}));
    EXPECT_EQ(median_ranks(12), (Ranks{3, 10}));
    EXPECT_EQ(median_ranks(15), (Ranks{4, 12}));
    EXPECT_EQ(median_ranks(20), (Ranks{6, 15}));
    EXPECT_EQ(median_ranks(30), (Ranks{10, 21}));
    for (std::size_t n = 0; n < 6; ++n)
        EXPECT_FALSE(median_ranks(n)) << n;
}

TEST(MedianRanks, CoverAtLeast95PercentAndNoneNarrowerDoes) {
    for (std::size_t n = 6; n <= 50; ++n) {
        const auto ranks = median_ranks(n);
        ASSERT_TRUE(ranks) << n;
        EXPECT_EQ(ranks->lo + ranks->hi, n + 1);
        EXPECT_GE(coverage(ranks->lo, n), 0.95) << n;
        EXPECT_LT(coverage(ranks->lo + 1, n), 0.95) << n;
    }
    const auto many = median_ranks(10'000); // normal approximation: 5000 - 0.98 * 100
    ASSERT_TRUE(many);
    EXPECT_NEAR(static_cast<double>(many->lo), 4902, 2);
}

TEST(SignTest, IsExact) {
    EXPECT_EQ(sign_test({}), 1);
    EXPECT_EQ(sign_test(std::vector{0.0, 0.0}), 1);
    EXPECT_NEAR(sign_test(std::vector(9, -0.5)), 2.0 / 512, 1e-15);
    EXPECT_NEAR(sign_test(std::vector{1., 1., 1., 1., -1., 0.}), 2 * 6.0 / 32, 1e-14);
    EXPECT_EQ(sign_test(std::vector{1., -1.}), 1);
}

TEST(Holm, StepsDown) {
    const auto adjusted = holm(std::vector{0.01, 0.04, 0.03, 0.005});
    const std::vector expected{0.03, 0.06, 0.06,
                               0.02}; // smallest first: x4, x3, x2, x1, never falling
    ASSERT_EQ(adjusted.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_DOUBLE_EQ(adjusted[i], expected[i]);
    EXPECT_TRUE(holm({}).empty());
    EXPECT_EQ(holm(std::vector{0.9, 0.8}), (std::vector{1.0, 1.0}));
}

TEST(RoundsNeeded, IsTheFirstThatCanPass) {
    EXPECT_EQ(rounds_needed(0), 9u);
    EXPECT_EQ(rounds_needed(12), 9u);
    EXPECT_EQ(rounds_needed(13), 10u);
    EXPECT_EQ(rounds_needed(819), 15u);
    EXPECT_EQ(rounds_needed(820), 16u);
}

TEST(PairedRatio, MedianAndInterval) {
    std::vector<double> logs;
    for (const double ratio : {1.2, 0.5, 2.0, 1.1, 1.3, 1.4})
        logs.push_back(std::log(ratio));
    const auto six = paired_ratio(logs);
    EXPECT_NEAR(six.ratio, std::sqrt(1.2 * 1.3), 1e-12);
    EXPECT_NEAR(six.ci_lo, 0.5, 1e-12);
    EXPECT_NEAR(six.ci_hi, 2.0, 1e-12);
    EXPECT_FALSE(six.is_identical);
    EXPECT_TRUE(paired_ratio(std::vector{0.0}).is_identical);
    EXPECT_FALSE(paired_ratio({}).is_identical);
    EXPECT_TRUE(std::isnan(paired_ratio({}).ratio));
    EXPECT_TRUE(std::isnan(paired_ratio(std::vector(5, 0.1)).ci_lo));
}

TEST(Verdict, CaseByCase) {
    const auto of = [](std::size_t n, double lo, double mid, double hi, double p, double floor) {
        return verdict({n, mid, lo, hi, p, false}, p, 0.05, floor);
    };
    EXPECT_EQ(of(9, 0.7, 0.8, 0.9, 0.01, 0), "faster");
    EXPECT_EQ(of(9, 1.1, 1.2, 1.3, 0.01, 0), "slower");
    EXPECT_EQ(of(9, 0.96, 1.0, 1.04, 0.9, 0), "same");
    EXPECT_EQ(of(9, 0.96, 1.0, 1.04, 0.9, 0.5), "cannot_tell"); // the machine cannot tell 5 %
    EXPECT_EQ(of(9, 1.01, 1.02, 1.04, 0.01, 0), "same");        // different, but by less than delta
    EXPECT_EQ(of(9, 0.9, 1.0, 1.1, 0.9, 0), "cannot_tell");     // wide
    EXPECT_EQ(of(9, 1.1, 1.2, 1.3, 0.06, 0), "cannot_tell");    // not significant in its family
    EXPECT_EQ(of(8, 0.7, 0.8, 0.9, 0.01, 0), "cannot_tell");    // too few
    EXPECT_EQ(of(9, 1.02, 1.15, 1.5, 0.01, 0.2), "cannot_tell"); // within the noise floor
    EXPECT_EQ(of(9, 0.85, 0.9, 1.15, 0.01, 0.2), "cannot_tell"); // noise does not make them equal
    EXPECT_EQ(verdict({1, 1, unknown, unknown, 1, true}, 1, 0.05, 0), "same");
}

TEST(Statistics, MedianIntervalAgreesWithItsRanks) {
    const MedianInterval nine = median_interval({9, 1, 8, 2, 7, 3, 6, 4, 5});
    EXPECT_EQ(nine.n, 9u);
    EXPECT_EQ(nine.mid, 5);
    EXPECT_EQ(nine.lo, 2);
    EXPECT_EQ(nine.hi, 8);
    EXPECT_TRUE(std::isnan(median_interval({1, 2, 3}).lo));
    EXPECT_TRUE(std::isnan(median_interval({}).mid));
}

TEST(Statistics, TheFittedLineLeavesTheLeastSquares) {
    const std::vector<double> x{1, 2, 4, 7}, y{3, 1, 4, 10};
    const Line line = fitted_line(x, y);
    // By hand: means 3.5 and 4.5; sums of products 28 and of squares 21.
    EXPECT_DOUBLE_EQ(line.slope, 28.0 / 21);
    EXPECT_DOUBLE_EQ(line.at_0, 4.5 - 28.0 / 21 * 3.5);
}

} // namespace
} // namespace boxwood::bench
