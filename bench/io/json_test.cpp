#include "bench/io/json.h"

#include <gtest/gtest.h>

#include <limits>

namespace boxwood::bench {
namespace {

TEST(Json, StringsAreEscaped) {
    EXPECT_EQ(json_string("plain"), "\"plain\"");
    EXPECT_EQ(json_string("a\"b\\c\nd\te"), "\"a\\\"b\\\\c\\nd\\te\"");
    EXPECT_EQ(json_string(std::string_view("\0\x1f\r", 3)), "\"\\u0000\\u001f\\u000d\"");
    EXPECT_EQ(json_string("\xc3\xa9"), "\"\xc3\xa9\""); // UTF-8 is left as it is
}

TEST(Json, NumbersRoundTripAndNonFiniteIsNull) {
    EXPECT_EQ(json_number(0.1), "0.1");
    EXPECT_EQ(json_number(0.1f), "0.1");
    EXPECT_EQ(json_number(1e300), "1e+300");
    EXPECT_EQ(json_number(-0.0), "-0");
    EXPECT_EQ(json_number(2.0), "2");
    EXPECT_EQ(json_number(std::numeric_limits<double>::infinity()), "null");
    EXPECT_EQ(json_number(std::numeric_limits<float>::quiet_NaN()), "null");
}

} // namespace
} // namespace boxwood::bench
