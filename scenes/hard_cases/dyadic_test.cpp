#include "scenes/hard_cases/dyadic.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <random>

namespace boxwood {
namespace {

/// 2^exponent in decimal.
std::string power_of_two(int exponent) {
    std::string digits = "1"; // least digit first
    for (int i = 0; i < exponent; ++i) {
        int carry = 0;
        for (char& c : digits) {
            const int twice = 2 * (c - '0') + carry;
            c = static_cast<char>('0' + twice % 10);
            carry = twice / 10;
        }
        if (carry)
            digits += static_cast<char>('0' + carry);
    }
    return {digits.rbegin(), digits.rend()};
}

TEST(Dyadic, SmallFractions) {
    EXPECT_EQ(dyadic("0", "1"), 0.0);
    EXPECT_EQ(dyadic("-0", "8"), 0.0);
    EXPECT_EQ(dyadic("-3", "4"), -0.75);
    EXPECT_EQ(dyadic("0012", "008"), 1.5);
    EXPECT_EQ(dyadic("6", "4294967296"), 6 * 0x1p-32);
    EXPECT_EQ(dyadic("-1", "8388608"), -0x1p-23);
}

TEST(Dyadic, EveryDoubleComesBack) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
        const auto m = static_cast<std::int64_t>(random() >> (11 + random() % 50));
        const int exponent = static_cast<int>(random() % 300);
        const std::string top = fmt::format("{}", random() % 2 ? m : -m);
        const double x = std::stod(top);
        EXPECT_EQ(dyadic(top, power_of_two(exponent)), std::ldexp(x, -exponent));
    }
}

TEST(Dyadic, LongIntegersAreReadExactly) {
    const std::string huge = power_of_two(900);
    EXPECT_EQ(dyadic(huge, power_of_two(900)), 1.0);
    EXPECT_EQ(dyadic("-" + huge, power_of_two(1000)), -0x1p-100);
    EXPECT_EQ(dyadic("3", power_of_two(1074)), 3 * 0x1p-1074);
    EXPECT_EQ(dyadic(power_of_two(1023), "1"), 0x1p1023);
    std::string odd = power_of_two(200); // 2^200 is ...376, so that 2^200 + 1 is ...377
    odd.back() = '7';
    EXPECT_EQ(dyadic(odd, "1"), std::nullopt);
}

TEST(Dyadic, WhatIsNoDoubleIsRefused) {
    EXPECT_EQ(dyadic("9007199254740992", "1"), 0x1p53);
    EXPECT_EQ(dyadic("9007199254740993", "1"), std::nullopt); // 54 bits
    EXPECT_EQ(dyadic("9007199254740994", "1"), 0x1p53 + 2);
    EXPECT_EQ(dyadic("1", power_of_two(1075)), std::nullopt);
    EXPECT_EQ(dyadic(power_of_two(1024), "1"), std::nullopt);
    EXPECT_EQ(dyadic("1", "3"), std::nullopt);
    EXPECT_EQ(dyadic("3", "6"), std::nullopt); // not in lowest terms and no power of two
    EXPECT_EQ(dyadic("1", "0"), std::nullopt);
    for (const char* text : {"", "-", "+1", "1.5", " 1", "1e3", "--1", "0x1"}) {
        EXPECT_EQ(dyadic(text, "1"), std::nullopt) << text;
        EXPECT_EQ(dyadic("1", text), std::nullopt) << text;
    }
    EXPECT_EQ(dyadic("1", "-2"), std::nullopt);
}

} // namespace
} // namespace boxwood
