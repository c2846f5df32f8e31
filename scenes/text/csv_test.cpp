#include "scenes/text/csv.h"

#include "kernels/testing/complaint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace boxwood {
namespace {

using Rows = std::vector<std::vector<double>>;
using ::testing::HasSubstr;

constexpr CsvFormat two{"a,b", 2, 2};
constexpr CsvFormat two_or_three{"a,b[,c]", 2, 3};
constexpr CsvFormat one{"a", 1, 1};

Rows rows_of(std::string_view text, const CsvFormat& format) {
    Rows rows;
    read_csv(text, "in.csv", format, [&](std::span<const double> numbers, std::size_t) {
        rows.emplace_back(numbers.begin(), numbers.end());
    });
    return rows;
}

double number(std::string_view text) { return rows_of(text, one).at(0).at(0); }

std::string complaint(std::string_view text, const CsvFormat& format) {
    return complaint_of<BadInput>([&] { rows_of(text, format); });
}

TEST(Csv, RowsCommentsBlanksSpacesAndLineEnds) {
    EXPECT_EQ(rows_of("1,2\n# a, note\n\n  \t\n 3 ,\t4 \r\n  # more\n+5,-6", two),
              (Rows{{1, 2}, {3, 4}, {5, -6}}));
    EXPECT_EQ(rows_of("", two), Rows{});
    EXPECT_EQ(rows_of("\n\n#\n", two), Rows{});
    EXPECT_EQ(rows_of("\xef\xbb\xbf"
                      "1,2\n",
                      two),
              (Rows{{1, 2}}));
    EXPECT_EQ(rows_of("1,2\n3,4,5\n", two_or_three), (Rows{{1, 2}, {3, 4, 5}}));
}

TEST(Csv, SaysHowManyRowsThereWere) {
    const auto ignored = [](std::span<const double>, std::size_t) {};
    EXPECT_EQ(read_csv("1,2\n# a\n3,4", "in.csv", two, ignored), 2u);
    EXPECT_EQ(read_csv("# only a comment\n", "in.csv", two, ignored), 0u);
}

TEST(Csv, LinesCountFromOneAndCountEveryLine) {
    std::vector<std::size_t> lines;
    read_csv("# head\n1,2\n\n3,4\n", "in.csv", two,
             [&](std::span<const double>, std::size_t line) { lines.push_back(line); });
    EXPECT_EQ(lines, (std::vector<std::size_t>{2, 4}));
}

TEST(Csv, NumbersAreRoundedToNearest) {
    EXPECT_EQ(number("0.1"), 0.1);
    EXPECT_EQ(number("-2.5e-3"), -2.5e-3);
    EXPECT_EQ(number("1e300"), 1e300);
    EXPECT_EQ(number(".5"), 0.5);
    EXPECT_EQ(number("5."), 5);
    EXPECT_EQ(number("1.7976931348623157e308"), std::numeric_limits<double>::max());
    EXPECT_EQ(number("9007199254740993"), 9007199254740992.0); // a tie goes to even
    EXPECT_EQ(std::bit_cast<std::uint64_t>(number("-0")), std::uint64_t{1} << 63);
}

TEST(Csv, SmallNumbersBecomeSubnormalOrZero) {
    EXPECT_EQ(number("1e-320"), 1e-320);
    EXPECT_EQ(number("4.9406564584124654e-324"), std::numeric_limits<double>::denorm_min());
    EXPECT_EQ(number("1e-400"), 0);
    EXPECT_TRUE(std::signbit(number("-1e-400")));
    EXPECT_EQ(number("0x1p-1074"), std::numeric_limits<double>::denorm_min());
    EXPECT_EQ(number("0x1p-1080"), 0);
}

TEST(Csv, HexFloats) {
    EXPECT_EQ(number("0x1.8p-3"), 0.1875);
    EXPECT_EQ(number("-0X1P+4"), -16);
    EXPECT_EQ(number("+0x.8p0"), 0.5);
    EXPECT_EQ(number("0x1.fffffffffffffp+1023"), std::numeric_limits<double>::max());
    EXPECT_EQ(number("0x1.999999999999ap-4"), 0.1);
}

TEST(Csv, InfinitiesAndNanArriveForTheCallerToJudge) {
    EXPECT_EQ(number("inf"), std::numeric_limits<double>::infinity());
    EXPECT_EQ(number("-Infinity"), -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(number("NaN")));
}

TEST(Csv, WhatIsNoNumberIsNamedWithItsPlace) {
    EXPECT_THAT(complaint("1,2\nmin,max\n", two), HasSubstr("in.csv:2: column 1 is 'min'"));
    EXPECT_THAT(complaint("1,2\nmin,max\n", two), HasSubstr("put # before other header lines"));
    for (const char* bad : {"1x", "--1", "+-1", "-+1", "0x", "0x-1", "1e", "1 2", "0x1p", "1_0",
                            "1;2", "\xff", "0x0x1", "e5", "."})
        EXPECT_THAT(complaint(bad, one), HasSubstr("in.csv:1: column 1")) << bad;
    EXPECT_THAT(complaint("1,,2", {"a,b,c", 3, 3}), HasSubstr("column 2 is empty"));
    EXPECT_THAT(complaint("1,2,", {"a,b,c", 3, 3}), HasSubstr("column 3 is empty"));
    EXPECT_THAT(complaint(std::string("1\0,2", 4), two), HasSubstr("'1?'"));
    EXPECT_THAT(complaint(std::string(1000, 'z'), one), HasSubstr("zzz...'"));
}

TEST(Csv, AFirstLineThatNamesTheColumnsIsNoRow) {
    // As pandas writes it; once, whole, in order.
    const CsvFormat format{"min,max[,id]", 2, 3};
    const auto rows_of = [&](const std::string& text) {
        return read_csv(text, "in.csv", format, [](auto, std::size_t) {});
    };
    for (const std::string header : {"min,max\n", "min, max,id\r\n", "# mine\n\n\"min\",\"max\"\n"})
        EXPECT_EQ(rows_of(header + "1,2\n"), 1u) << header;
    for (const std::string bad : {"max,min\n1,2\n", "min\n1,2\n", "min,max\nmin,max\n",
                                  "min,max,id,more\n", "min,maxx\n", "1,2\nmin,max\n"})
        EXPECT_THROW(rows_of(bad), BadInput) << bad;
}

TEST(Csv, TooLargeNumbersAreRefused) {
    EXPECT_THAT(complaint("1e400", one), HasSubstr("larger than every double"));
    EXPECT_THAT(complaint("-0x1p1024", one), HasSubstr("larger than every double"));
}

TEST(Csv, AWrongNumberOfColumnsIsNamed) {
    EXPECT_THAT(complaint("1", two), HasSubstr("in.csv:1: 1 column, expected 2: a,b"));
    EXPECT_THAT(complaint("\n1,2,3", two), HasSubstr("in.csv:2: 3 columns, expected 2"));
    EXPECT_THAT(complaint("1,2,3,x", two_or_three), HasSubstr("4 columns, expected 2 to 3"));
}

TEST(Csv, CommentsBehindNumbersAndCarriageReturnsAloneAreNamed) {
    EXPECT_THAT(complaint("1,2 # c\n", two), HasSubstr("in.csv:1: a comment stands behind"));
    EXPECT_THAT(complaint("1,2\r3,4\r", two), HasSubstr("in.csv:1: lines end in carriage returns"));
}

} // namespace
} // namespace boxwood
