#include "bench/commands/command.h"
#include "bench/commands/queries/query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;

class QueryTriangles : public ::testing::Test {
  protected:
    ~QueryTriangles() override { std::filesystem::remove(file_); }

    TrianglesQuery rows(const std::string& text) const {
        std::ofstream(file_) << text;
        TrianglesQuery query;
        query.pairs = file_.string();
        return query;
    }
    static std::string answer(const TrianglesQuery& query) {
        std::ostringstream out;
        run(query, out);
        return out.str();
    }
    static std::string complaint(const TrianglesQuery& query) {
        try {
            return "answered: " + answer(query);
        } catch (const BadInput& e) {
            return e.what();
        }
    }

    std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                  ("boxwood_triangles_" + std::to_string(std::random_device{}()));
};

const std::string crossing = "0,0,0,2,0,0,0,2,0,1,1,-1,1,1,1,3,1,0\n";
const std::string coplanar_apart = "0,0,0,1,0,0,0,1,0,10,10,0,11,10,0,10,11,0\n";
const std::string points_that_meet = "1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1\n";

TEST_F(QueryTriangles, TouchOrNot) {
    EXPECT_EQ(answer(rows(crossing + "# a comment\n" + coplanar_apart + points_that_meet)),
              "1\n0\n1\n");
    TrianglesQuery query = rows(crossing);
    query.format.header = true;
    EXPECT_EQ(answer(query), "touch\n1\n");
}

TEST_F(QueryTriangles, TheDefaultIsExact) {
    // A corner of B lies on A's plane, or one unit in the last place below or above it.
    const auto row = [](const char* z) {
        return std::string("0,0,0x1p-1,3,0,0x1p-1,0,3,0x1p-1,1,1,") + z + ",1,1,9,2,1,9\n";
    };
    EXPECT_EQ(
        answer(rows(row("0x1p-1") + row("0x1.0000000000001p-1") + row("0x1.fffffffffffffp-2"))),
        "1\n0\n1\n");
    const std::string tiny = "0,0,0,0x1p-1074,0,0,0,0x1p-1074,0,0,0,0x1p-1074,1,0,1,0,1,1\n";
    EXPECT_EQ(answer(rows(tiny)), "0\n");
}

TEST_F(QueryTriangles, EveryKernelAnswersASimpleQuestion) {
    for (const char* kernel :
         {"moller_f32", "moller_f64", "sat_f64", "sat_certified", "guigue_devillers_f32",
          "guigue_devillers_f64", "guigue_devillers_exact", "rational"}) {
        TrianglesQuery query = rows(crossing + "0,0,0,1,0,0,0,1,0,5,5,5,6,5,5,5,6,5\n");
        query.kernel = kernel;
        EXPECT_EQ(answer(query), "1\n0\n") << kernel;
    }
}

TEST_F(QueryTriangles, DistanceWithBounds) {
    TrianglesQuery query = rows(coplanar_apart + crossing);
    query.distance = true;
    std::istringstream out(answer(query));
    std::string line;
    ASSERT_TRUE(std::getline(out, line));
    double d = 0, lo = 0, hi = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &d, &lo, &hi), 3);
    EXPECT_NEAR(d, 13.435028842544403, 1e-12);
    EXPECT_LE(lo, d);
    EXPECT_LE(d, hi);
    EXPECT_LT(hi - lo, 1e-12);
    ASSERT_TRUE(std::getline(out, line));
    EXPECT_EQ(line, "0,0,0");
}

TEST_F(QueryTriangles, Json) {
    TrianglesQuery query = rows(crossing + coplanar_apart);
    query.format.json = true;
    EXPECT_EQ(answer(query), "{\"n\":2,\"kernel\":\"guigue_devillers_exact\",\"answers\":[1,0],"
                             "\"undecided\":[],\"tiers\":[0,0]}\n");
    query.distance = true;
    EXPECT_THAT(answer(query), HasSubstr("\"kernel\":\"certified\",\"answers\":[{\"distance\":0,"));
}

TEST_F(QueryTriangles, BadInput) {
    EXPECT_THAT(complaint(rows("1,2,3\n")), HasSubstr(":1: "));
    EXPECT_THAT(complaint(rows(crossing + "0,0,0,2,0,0,0,2,0,1,1,-1,1,1,1,3,1,nan\n")),
                HasSubstr(":2: number 18 of the row is nan"));
    TrianglesQuery query = rows(crossing);
    query.kernel = "guigue_devilers_exact";
    EXPECT_THAT(complaint(query), HasSubstr("guigue_devillers_exact"));
    query.kernel = "certified"; // a distance kernel
    EXPECT_THAT(complaint(query), HasSubstr("triangle kernel"));
    query = {};
    query.pairs = "/no/such/file.csv";
    EXPECT_THAT(complaint(query), HasSubstr("/no/such/file.csv"));
}

} // namespace
} // namespace boxwood::bench
