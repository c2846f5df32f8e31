#include "kernels/oracle/roots.h"

#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/exact_vector.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace boxwood::oracle {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();

/// Finite doubles of every size, denormals and small whole numbers among them.
std::vector<double> doubles(std::size_t n) {
    std::mt19937_64 random(3);
    std::vector<double> all{0, -0.0, 1, -1, 2, 0x1p-1074, -0x1p-1074, 0x1p-1022, largest, -largest};
    while (all.size() < n) {
        const auto bits = random();
        const double x = bits % 4 ? std::bit_cast<double>(bits) : static_cast<double>(bits % 1000);
        if (std::isfinite(x))
            all.push_back(x);
    }
    return all;
}

TEST(OracleRoots, ExactReadsWhatTheDoubleIs) {
    for (const double x : doubles(2000)) {
        ASSERT_EQ(exact(x), mpq_class(x)) << x;
        const auto f = static_cast<float>(x);
        if (std::isfinite(f)) {
            ASSERT_EQ(exact(f), mpq_class(f)) << f;
        }
        ASSERT_EQ(nearest_double(exact(x)), x);
    }
}

// A float is the nearest if no double between it and its neighbours is half way or more.
TEST(OracleRoots, NearestFloatOfWhatNoDoubleHolds) {
    for (const double x : doubles(2000)) {
        EXPECT_EQ(nearest_float(exact(x)), static_cast<float>(x)) << x;
        const auto f = std::abs(static_cast<float>(x));
        const double above =
            static_cast<double>(std::nextafter(f, std::numeric_limits<float>::infinity()));
        if (std::isinf(above))
            continue;
        const mpq_class tie = (exact(f) + exact(above)) / 2, little = scaled(mpq_class(1), -2000);
        EXPECT_EQ(nearest_float(tie - little), f);
        EXPECT_EQ(nearest_float(tie + little), static_cast<float>(above));
        EXPECT_EQ(nearest_float(-tie - little), -static_cast<float>(above));
    }
}

/// q is in [ (r + below)/2, (r + above)/2 ]^2, and only if r is even may it be an end.
void expect_nearest(double r, const mpq_class& q) {
    const auto square_of_mid = [](double x, double y) {
        const mpq_class mid = (exact(x) + exact(y)) / 2;
        return mpq_class(mid * mid);
    };
    const bool even = std::bit_cast<std::uint64_t>(r) % 2 == 0;
    if (r > 0) {
        const int low = cmp(q, square_of_mid(r, std::nextafter(r, 0.0)));
        EXPECT_TRUE(low > 0 || (low == 0 && even)) << r;
    }
    if (r < largest) {
        const int high = cmp(q, square_of_mid(r, std::nextafter(r, inf)));
        EXPECT_TRUE(high < 0 || (high == 0 && even)) << r;
    }
}

TEST(OracleRoots, NearestRootIsNearest) {
    std::mt19937_64 random(4);
    const auto all = doubles(3000);
    for (std::size_t i = 0; i + 1 < all.size() && !HasFailure(); ++i) {
        const mpq_class x = exact(std::abs(all[i])), y = exact(std::abs(all[i + 1]));
        EXPECT_EQ(nearest_sqrt(x * x), std::abs(all[i]));
        std::vector<mpq_class> squares{x, x * y};
        if (y != 0) {
            squares.emplace_back(x / y);
            squares.emplace_back(x * x * y / (y + 1)); // a little below a square
        }
        // Half way to the next double, where the tie is, and next to there.
        const mpq_class half = scaled(mpq_class(1), -1075);
        mpq_class mid = x + half;
        squares.emplace_back(mid * mid);
        mid = (x + exact(std::nextafter(std::abs(all[i]), 0.0))) / 2;
        squares.emplace_back(mid * mid);
        squares.emplace_back(mid * mid * (1 + scaled(mpq_class(1), -3000)));
        for (const mpq_class& q : squares) {
            const double r = nearest_sqrt(q);
            if (std::isinf(r))
                EXPECT_GT(q, exact(largest) * exact(largest));
            else
                expect_nearest(r, q);
        }
    }
}

TEST(OracleRoots, RootsBeyondTheDoubles) {
    const mpq_class top = exact(largest), half_step = scaled(mpq_class(1), 970);
    EXPECT_EQ(nearest_sqrt(top * top), largest);
    const mpq_class below = top + half_step - 1, at = top + half_step;
    EXPECT_EQ(nearest_sqrt(below * below), largest);
    EXPECT_EQ(nearest_sqrt(at * at), inf);
    EXPECT_EQ(nearest_sqrt(scaled(mpq_class(1), -2148)), 0x1p-1074);
    EXPECT_EQ(nearest_sqrt(scaled(mpq_class(1), -2150)), 0); // a tie: to even
    EXPECT_EQ(nearest_sqrt(scaled(mpq_class(1001, 1000), -2150)), 0x1p-1074);
    EXPECT_EQ(nearest_sqrt(0), 0);
}

/// (d - sqrt(q)) / ulp by MPFR in 5000 bits.
double ulps_by_mpfr(double d, const mpq_class& q) {
    mpfr_t root;
    mpfr_init2(root, 5000);
    mpfr_set_q(root, q.get_mpq_t(), MPFR_RNDN);
    mpfr_sqrt(root, root, MPFR_RNDN);
    const double r = mpfr_get_d(root, MPFR_RNDN);
    mpfr_d_sub(root, d, root, MPFR_RNDN);
    int exponent = 0;
    (void)std::frexp(r, &exponent);
    mpfr_mul_2si(root, root, -std::max(exponent - 53, -1074), MPFR_RNDN);
    const double ulps = mpfr_get_d(root, MPFR_RNDN);
    mpfr_clear(root);
    return ulps;
}

TEST(OracleRoots, UlpsAreThoseOfMpfr) {
    const auto all = doubles(2000);
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        const mpq_class q = abs(exact(all[i]) * exact(all[i + 1]));
        const double r = nearest_sqrt(q);
        if (r == 0 || std::isinf(r))
            continue;
        EXPECT_LE(std::abs(ulps_off(r, q)), 0.5);
        for (const double d : {r, std::nextafter(r, inf), r * (1 + 1e-10), r * 0.3, all[i], 0.0}) {
            if (!std::isfinite(d))
                continue;
            const double expected = ulps_by_mpfr(d, q), got = ulps_off(d, q);
            if (std::isinf(expected))
                ASSERT_EQ(got, expected);
            else
                ASSERT_NEAR(got, expected, 1e-15 + 1e-15 * std::abs(expected)) << d << ' ' << r;
        }
    }
    EXPECT_EQ(ulps_off(2, 4), 0);
    EXPECT_EQ(ulps_off(0x1.0000000000001p+1, 4), 1);
    EXPECT_EQ(ulps_off(0, 0), 0);
    EXPECT_EQ(ulps_off(0x1p-1074, 0), 1);
    EXPECT_EQ(ulps_off(inf, 4), inf);
    EXPECT_TRUE(std::isnan(ulps_off(std::nan(""), 4)));
}

TEST(OracleRoots, CompareHoldsSquaresAgainstEachOther) {
    const mpq_class two = 2;
    const double root = std::sqrt(2.0);
    EXPECT_EQ(compare(root, two), 1); // sqrt(2) is rounded up
    EXPECT_EQ(compare(std::nextafter(root, 0.0), two), -1);
    EXPECT_EQ(compare(3, 9), 0);
    EXPECT_EQ(compare(-3, 9), -1);
    EXPECT_EQ(compare(-0.0, 0), 0);
    EXPECT_EQ(compare(-0x1p-1074, 0), -1);
    EXPECT_EQ(compare(0x1p-1074, 0), 1);
    EXPECT_EQ(compare(inf, 9), 1);
    EXPECT_EQ(compare(-inf, 9), -1);
}

TEST(OracleRoots, NeighboursOfADouble) {
    for (const double x : doubles(500)) {
        EXPECT_EQ(next_above(std::abs(x)), std::nextafter(std::abs(x), inf));
        EXPECT_EQ(next_below(std::abs(x)), std::nextafter(std::abs(x), 0.0));
    }
    EXPECT_EQ(next_above(inf), inf);
    EXPECT_EQ(next_below(inf), largest);
}

} // namespace
} // namespace boxwood::oracle
