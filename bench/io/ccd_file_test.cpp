#include "bench/io/ccd_file.h"

#include "bench/io/bad_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;

std::string complaint(const std::string& text) {
    try {
        return std::to_string(read_ccd_queries(text, "q.csv").size()) + " queries";
    } catch (const BadInput& e) {
        return e.what();
    }
}

std::string repeated(const std::string& row, int times) {
    std::string text;
    for (int i = 0; i < times; ++i)
        text += row + "\n";
    return text;
}
const std::string row = "1,2,-3,4,5,1,0";

TEST(CcdFile, ReadsWholeNumbersOfAnySize) {
    const std::string big(80, '9');
    const std::string text = "\xef\xbb\xbf# a comment\n\n" + repeated(row, 3) +
                             " 6 , 4, +7,-14 ,0,5,0\r\n" + repeated(row, 3) + big + ",3,1,1,1," +
                             big + ",0";
    const auto queries = read_ccd_queries(text, "q.csv");
    ASSERT_EQ(queries.size(), 1u);
    const CcdFileQuery& query = queries[0];
    EXPECT_FALSE(query.touches);
    EXPECT_EQ(query.lines, (std::array<std::size_t, 8>{3, 4, 5, 6, 7, 8, 9, 10}));
    EXPECT_EQ(query.motion.start[0],
              (oracle::RationalPoint{mpq_class(1, 2), mpq_class(-3, 4), mpq_class(5)}));
    EXPECT_EQ(query.motion.start[3],
              (oracle::RationalPoint{mpq_class(3, 2), mpq_class(-1, 2), mpq_class(0)}));
    EXPECT_EQ(query.motion.end[3][0], mpq_class(mpz_class(big) / 3));
    EXPECT_EQ(query.motion.end[3][2] * mpz_class(big), 1);
}

TEST(CcdFile, ATextWithoutRowsIsAWarning) {
    for (const char* text : {"", "# nothing\n\n"}) {
        ::testing::internal::CaptureStderr();
        EXPECT_EQ(complaint(text), "0 queries");
        EXPECT_EQ(::testing::internal::GetCapturedStderr(),
                  "boxwood: warning: q.csv holds no rows of "
                  "x_num,x_den,y_num,y_den,z_num,z_den,truth\n");
    }
}

TEST(CcdFile, BadRowsAreNamed) {
    EXPECT_EQ(complaint(repeated(row, 16)), "2 queries");
    EXPECT_THAT(complaint(repeated(row, 8) + repeated(row, 3)),
                HasSubstr("q.csv:9: the last query has 3 rows of 8"));
    EXPECT_THAT(complaint(row + "\n1,2,3,4,5,6\n"),
                HasSubstr("q.csv:2: 6 columns, expected 7: x_num,x_den"));
    EXPECT_THAT(complaint(row + ",1"), HasSubstr("q.csv:1: 8 columns"));
    EXPECT_THAT(complaint("# x\n1,2,3,0,5,6,0"), HasSubstr("q.csv:2: y_den is 0; a denominator"));
    EXPECT_THAT(complaint("1,2,0.5,4,5,6,0"), HasSubstr("y_num is '0.5'; rows are integers"));
    EXPECT_THAT(complaint("1,2,,4,5,6,0"), HasSubstr("y_num is empty"));
    EXPECT_THAT(complaint("1,2,-,4,5,6,0"), HasSubstr("y_num is '-'"));
    EXPECT_THAT(complaint("1,2,1 2,4,5,6,0"), HasSubstr("y_num is '1 2'"));
    EXPECT_THAT(complaint("x_num,x_den,y_num,y_den,z_num,z_den,truth\n"),
                HasSubstr("put # before a header line"));
    EXPECT_THAT(complaint("1,2,3,4,5,6,2"), HasSubstr("q.csv:1: truth is '2'; it must be 0"));
    EXPECT_THAT(complaint(row + "\n1,2,3,4,5,6,1\n"),
                HasSubstr("q.csv:2: truth is 1, but 0 in line 1"));
}

TEST(CcdFile, DoublesOrTheRowThatIsNone) {
    const auto doubles = [](const std::string& eighth) {
        try {
            const auto queries = read_ccd_queries(repeated(row, 7) + eighth, "q.csv");
            const LinearMotion motion = exact_doubles(queries[0], "q.csv");
            EXPECT_EQ(motion.start[1], (Vec3<double>{0.5, -0.75, 5}));
            return std::string("x = ") + std::to_string(motion.end[3].x);
        } catch (const BadInput& e) {
            return std::string(e.what());
        }
    };
    EXPECT_EQ(doubles("-3,8,1,1,1,1,0"), "x = -0.375000");
    EXPECT_THAT(doubles("1,3,1,1,1,1,0"),
                HasSubstr("q.csv:8: x = '1/3' is not exactly a double, and this kernel reads "
                          "doubles; use --kernel exact"));
    const std::string huge = "1" + std::string(400, '0');
    EXPECT_THAT(doubles("1,1,1,1," + huge + ",1,0"), HasSubstr("z = '1000"));
    EXPECT_THAT(doubles("1,1,1," + huge + ",1,1,0"), HasSubstr("y = '1/1000"));
}

} // namespace
} // namespace boxwood::bench
