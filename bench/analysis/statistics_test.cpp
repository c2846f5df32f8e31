#include "bench/analysis/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

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

TEST(Corrected, StepsUp) {
    // By hand: 0.005 x 4, 0.01 x 4 / 2, 0.03 x 4 / 3, 0.2; none above a larger one's.
    const Corrected four = corrected(std::vector{0.01, 0.2, 0.03, 0.005});
    const std::vector p_adj{0.02, 0.2, 0.04, 0.02};
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_DOUBLE_EQ(four.p_adj[i], p_adj[i]);
    EXPECT_DOUBLE_EQ(four.level, 0.05 * 3 / 4); // three are claimed
    EXPECT_DOUBLE_EQ(corrected(std::vector{0.9, 0.8}).level, 0.025);
    EXPECT_EQ(corrected(std::vector{0.9, 0.8}).p_adj, (std::vector{0.9, 0.9}));
    EXPECT_TRUE(corrected({}).p_adj.empty());
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
    EXPECT_TRUE(std::isnan(paired_ratio({}).ratio));
    EXPECT_TRUE(std::isnan(paired_ratio(std::vector(5, 0.1)).ci_lo));
}

using results::Reason, results::Verdict;
using Logs = std::vector<double>;

std::vector<Ruling> decide_all(const std::vector<Logs>& family, double floor = 0) {
    std::vector<Claim> claims;
    for (const Logs& logs : family)
        claims.push_back({logs, floor});
    return decide(claims, 0.05);
}

/// Ratios of as many rounds.
Logs logs_of(std::initializer_list<double> ratios) {
    Logs logs;
    for (const double ratio : ratios)
        logs.push_back(std::log(ratio));
    return logs;
}

TEST(Decide, CaseByCase) {
    const auto of = [](std::initializer_list<double> ratios, double floor = 0) {
        const Ruling one = decide_all({logs_of(ratios)}, floor)[0];
        return std::pair{one.verdict, one.reason};
    };
    const auto open = [](Reason reason) { return std::pair{Verdict::cannot_tell, reason}; };
    const auto said = [](Verdict verdict) { return std::pair{verdict, Reason::none}; };
    EXPECT_EQ(of({.7, .7, .8, .8, .8, .8, .8, .9, .9}), said(Verdict::faster));
    EXPECT_EQ(of({1.1, 1.1, 1.2, 1.2, 1.2, 1.2, 1.2, 1.3, 1.3}), said(Verdict::slower));
    EXPECT_EQ(of({.5, 1.1, 1.2, 1.2, 1.2, 1.2, 1.2, 1.3, 9}), said(Verdict::slower)); // two bad
    EXPECT_EQ(of({.5, .96, 1, 1, 1, 1, 1, 1.04, 2}), said(Verdict::same));
    EXPECT_EQ(of({.96, .96, 1, 1, 1, 1, 1, 1.04, 1.04}, .15), open(Reason::below_the_floor));
    EXPECT_EQ(of({1.01, 1.01, 1.02, 1.02, 1.02, 1.02, 1.02, 1.03, 1.03}), said(Verdict::same));
    EXPECT_EQ(of({.9, .9, .9, 1, 1, 1, 1.1, 1.1, 1.1}), open(Reason::crosses_1));
    EXPECT_EQ(of({.7, .7, .7, .8, .8, .8, .8, .8}), open(Reason::too_few_rounds));
    EXPECT_EQ(of({1.1, 1.1, 1.15, 1.15, 1.15, 1.15, 1.15, 1.5, 1.5}, .2),
              open(Reason::below_the_floor));
    // The ratio is beyond the floor, the interval reaches into it: enough where the floor is small.
    EXPECT_EQ(of({1.1, 1.1, 1.3, 1.3, 1.3, 1.3, 1.3, 1.5, 1.5}, .15),
              open(Reason::below_the_floor));
    EXPECT_EQ(of({.9, .9, .7, .7, .7, .7, .7, .6, .6}, .15), open(Reason::below_the_floor));
    EXPECT_EQ(of({1.03, 1.03, 1.3, 1.3, 1.3, 1.3, 1.3, 1.5, 1.5}, .04), said(Verdict::slower));
    EXPECT_EQ(of({1, 1, 1}), open(Reason::too_few_rounds)); // even for the same data
    EXPECT_EQ(of({1, 1, 1, 1, 1, 1, 1, 1, 1}), said(Verdict::same));
    EXPECT_EQ(of({1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2}, .21), open(Reason::too_noisy));
    EXPECT_EQ(of({3, 3, 3, 3, 3, 3, 3, 3, 3}, .75), said(Verdict::slower)); // beyond any noise
}

TEST(Decide, TheIntervalIsTheOneThatDecided) {
    // One bad round of nine: alone a claim stands, beside two that say nothing it does not, and its
    // interval says so; beside another that stands it does.
    const Logs bad = logs_of({.5, 1.2, 1.3, 1.3, 1.3, 1.3, 1.3, 1.4, 1.5}), good(9, std::log(1.3)),
               nothing = logs_of({.7, .7, .8, .8, 1.1, 1.2, 1.3, 1.4, 1.5});
    const Ruling alone = decide_all({bad})[0];
    EXPECT_EQ(alone.verdict, Verdict::slower);
    EXPECT_NEAR(alone.ratio.ci_lo, 1.2, 1e-12);
    const Ruling beside = decide_all({bad, nothing, nothing})[0];
    EXPECT_EQ(beside.reason, Reason::crosses_1);
    EXPECT_GT(beside.p_adj, 0.05);
    EXPECT_NEAR(beside.ratio.ci_lo, .5, 1e-12);
    EXPECT_EQ(decide_all({bad, good})[0].verdict, Verdict::slower);
    std::vector<Logs> many(13, nothing);
    many[0] = good; // 13 * 2 / 512 > 0.05
    EXPECT_EQ(decide_all(many)[0].reason, Reason::too_few_rounds);
    EXPECT_TRUE(std::isnan(decide_all(many)[0].ratio.ci_lo));
    for (const Ruling& ruling : decide_all(std::vector(300, good))) // all three times slower
        EXPECT_EQ(ruling.verdict, Verdict::slower);
}

TEST(Decide, OneDisturbedRoundOverturnsNothingAtTheDefaults) {
    // 1.24 in fourteen rounds, and a round in which the machine did something else.
    Logs logs(15, std::log(1.24));
    logs[7] = std::log(0.4);
    std::vector<Logs> family(
        50, logs_of({.9, .9, .95, .95, .97, .98, .99, 1, 1.01, 1.02, 1.03, 1.05, 1.05, 1.1, 1.1}));
    family[3] = logs;
    EXPECT_EQ(decide_all(family)[3].verdict, Verdict::slower);
    EXPECT_NEAR(decide_all(family)[3].ratio.ratio, 1.24, 1e-12);
}

TEST(Decide, IntervalsHoldTheMedianOfEveryInput) {
    // Five inputs of three rounds, one of which says something else than the four.
    Logs logs;
    std::vector<std::uint32_t> inputs;
    for (std::uint32_t round = 0; round < 15; ++round) {
        inputs.push_back(round % 5);
        logs.push_back(std::log(round % 5 == 4 ? .9 : 1.3) + 1e-4 * round);
    }
    const InputMedians medians = input_medians(logs, inputs);
    EXPECT_NEAR(std::exp(medians.lo), .9, 1e-2);
    EXPECT_NEAR(std::exp(medians.hi), 1.3, 1e-2);
    const Claim pooled{logs, 0}, by_input{logs, 0, medians};
    EXPECT_EQ(decide({{pooled}}, .05)[0].verdict, Verdict::slower);
    const Ruling ruling = decide({{by_input}}, .05)[0];
    EXPECT_EQ(ruling.reason, Reason::crosses_1);
    EXPECT_NEAR(ruling.ratio.ci_lo, .9, 1e-2);
    EXPECT_NEAR(ruling.ratio.ratio, 1.3, 1e-2);
    // Inputs of two rounds have no say, nor has a single input.
    inputs[4] = 3;
    EXPECT_NEAR(std::exp(input_medians(logs, inputs).lo), 1.3, 1e-2);
    EXPECT_TRUE(std::isnan(input_medians(logs, std::vector<std::uint32_t>(15, 2)).lo));
    EXPECT_TRUE(std::isnan(input_medians({}, {}).lo));
}

/// Log-ratios of rounds on a machine whose noise has heavy tails: two per cent on either side, and
/// in one round of thirty up to a factor of three.
Logs noisy_rounds(std::size_t n, double ratio, std::mt19937_64& random) {
    std::normal_distribution<double> usual(0, 0.02);
    std::uniform_real_distribution<double> share(0, 1), burst(-std::log(3.0), std::log(3.0));
    Logs logs;
    for (std::size_t i = 0; i < n; ++i)
        logs.push_back(std::log(ratio) + usual(random) - usual(random) +
                       (share(random) < 1. / 30 ? burst(random) : 0));
    return logs;
}

TEST(Decide, FindsEightPerCentAndClaimsHardlyAnythingFalseAtTheDefaults) {
    constexpr std::size_t rounds = 15, claims = 40, families = 300;
    constexpr double floor = 0.02;
    std::mt19937_64 random(11);
    std::size_t found = 0, false_alone = 0;
    double false_share = 0;
    for (std::size_t f = 0; f < families; ++f) {
        // Of forty timings one is 8 % slower, or none.
        std::vector<Logs> one, none;
        for (std::size_t i = 0; i < claims; ++i) {
            one.push_back(noisy_rounds(rounds, i == 0 ? 1.08 : 1, random));
            none.push_back(noisy_rounds(rounds, 1, random));
        }
        const auto is_claimed = [](const Ruling& ruling) {
            return ruling.verdict == Verdict::slower || ruling.verdict == Verdict::faster;
        };
        const auto rulings = decide_all(one, floor), nothing = decide_all(none, floor);
        found += rulings[0].verdict == Verdict::slower;
        const auto claimed = std::ranges::count_if(rulings, is_claimed);
        if (claimed > 0)
            false_share += static_cast<double>(claimed - is_claimed(rulings[0])) /
                           static_cast<double>(claimed);
        false_alone += std::ranges::any_of(nothing, is_claimed);
    }
    EXPECT_GT(found, families * 90 / 100);
    EXPECT_LT(false_share / families, 0.05);
    EXPECT_LT(false_alone, families * 5 / 100);
}

TEST(Decide, VerdictAndCorrectedPAgree) {
    // The interval at the level of a claim inverts the sign test: no verdict without the other.
    for (std::size_t claims = 1; claims < 6; ++claims)
        for (std::size_t n = 9; n < 20; ++n)
            for (std::size_t below = 0; below < n / 2; ++below) {
                Logs logs(n, 0.5);
                std::fill_n(logs.begin(), below, -0.25);
                for (const Ruling& claim : decide_all(std::vector(claims, logs)))
                    EXPECT_EQ(claim.verdict == Verdict::slower, claim.p_adj <= family_error)
                        << claims << " claims, " << below << " of " << n << " below";
            }
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
