#include "scenes/robots/random_values.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <vector>

namespace boxwood {
namespace {

const std::vector<ValueRange> ranges{
    {-2, 3, false},
    {-std::numbers::pi, std::numbers::pi, true},
    {.25, .25, false},
    {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max(), false}};

TEST(RandomValues, LieInTheirRangesAndFillThem) {
    std::vector<double> values(4);
    double lowest = 9, highest = -9, sum = 0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
        random_values(ranges, 1, i, values);
        for (std::size_t k = 0; k < 4; ++k)
            ASSERT_TRUE(ranges[k].lower <= values[k] && values[k] <= ranges[k].upper) << values[k];
        lowest = std::min(lowest, values[0]);
        highest = std::max(highest, values[0]);
        sum += values[0];
    }
    EXPECT_LT(lowest, -1.99);
    EXPECT_GT(highest, 2.99);
    EXPECT_NEAR(sum / 20000, .5, .05);
}

TEST(RandomValues, StateIDependsOnTheSeedAndIAlone) {
    std::vector<double> one(4), again(4), other(4);
    random_values(ranges, 7, 3, one);
    random_values(ranges, 7, 4, other);
    random_values(ranges, 7, 3, again);
    EXPECT_EQ(one, again);
    EXPECT_NE(one[0], other[0]);
    random_values(ranges, 8, 3, other);
    EXPECT_NE(one[0], other[0]);
}

// By a Philox4x32-10 written in Python, with Python's own doubles.
TEST(RandomValues, AreTheSameBitsOnEveryMachine) {
    std::vector<double> values(4);
    random_values(ranges, 1, 0, values);
    EXPECT_EQ(values[0], 0x1.296c26dea3661p+0);
    EXPECT_EQ(values[1], -0x1.98e5e03db4de8p-2);
    random_values(ranges, 1, 12345678901, values);
    EXPECT_EQ(values[0], -0x1.d2a5e3417ac6bp-1);
    EXPECT_EQ(values[1], 0x1.d72187af25e50p+0);
}

} // namespace
} // namespace boxwood
