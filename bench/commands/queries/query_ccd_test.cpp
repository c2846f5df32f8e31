#include "bench/commands/command.h"
#include "bench/commands/queries/query.h"
#include "bench/io/ccd_file.h"
#include "bench/io/csv.h"
#include "kernels/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A vertex that falls from 1 to `to` over a face at rest, with the truth given.
std::string falling(const std::string& to, const std::string& truth, const std::string& x = "1,4") {
    const std::string face =
        "0,1,0,1,0,1," + truth + "\n1,1,0,1,0,1," + truth + "\n0,1,1,1,0,1," + truth + "\n";
    return x + ",1,4,1,1," + truth + "\n" + face + x + ",1,4," + to + "," + truth + "\n" + face;
}

class QueryCcd : public ::testing::Test {
  protected:
    QueryCcd()
        : file_(fs::temp_directory_path() /
                ("boxwood_ccd_" + std::to_string(std::random_device{}()) + ".csv")) {}
    ~QueryCcd() override { fs::remove(file_); }

    CcdQuery query(const std::string& text, const std::string& kernel = "exact") const {
        std::ofstream(file_) << text;
        CcdQuery query;
        query.queries = file_.string();
        query.kind = "vertex-face";
        query.kernel = kernel;
        return query;
    }
    static std::string answer(const CcdQuery& query) {
        std::ostringstream out;
        run(query, out);
        return out.str();
    }
    static std::string complaint(const CcdQuery& query) {
        try {
            return "answered: " + answer(query);
        } catch (const BadInput& e) {
            return e.what();
        }
    }

    fs::path file_;
};

TEST_F(QueryCcd, OneLinePerQuery) {
    const std::string text = falling("-1,1", "1") + falling("0,1", "1") + falling("1,8388608", "0");
    EXPECT_EQ(answer(query(text)), "1\n1\n0\n");
    EXPECT_EQ(answer(query(text, "tight_inclusion")), "1\n1\n0\n");
    CcdQuery headed = query(text);
    headed.format.header = true;
    EXPECT_EQ(answer(headed), "touch\n1\n1\n0\n");
}

TEST_F(QueryCcd, JsonCountsWrongAnswersAgainstTheFile) {
    CcdQuery q = query(falling("-1,1", "0") + falling("1,8", "1") + falling("-1,1", "1"));
    q.format.json = true;
    EXPECT_EQ(answer(q),
              "{\"n\":3,\"false_positives\":1,\"false_negatives\":1,\"answers\":[1,0,1]}\n");
}

TEST_F(QueryCcd, RationalPointsForTheExactKernelAlone) {
    // Down to 10^-40 above the face, and onto it: no double tells.
    const std::string tiny = "1,1" + std::string(40, '0');
    const std::string text = falling(tiny, "0", "1,3") + falling("0,7", "1", "1,3");
    EXPECT_EQ(answer(query(text)), "0\n1\n");
    EXPECT_THAT(complaint(query(text, "tight_inclusion")),
                HasSubstr(".csv:1: x = '1/3' is not exactly a double"));
    EXPECT_THAT(complaint(query(text, "cubic_f64")), HasSubstr("--kernel exact"));
}

TEST_F(QueryCcd, SettingsOfTightInclusion) {
    const std::string near = falling("1,1024", "0");
    CcdQuery q = query(near, "tight_inclusion");
    EXPECT_EQ(answer(q), "0\n");
    q.max_checks = 0; // the boxes of the motions are apart all the same
    EXPECT_EQ(answer(q), "0\n");
    // The face turns away before a vertex at rest: a plane or two are not enough to tell.
    q = query("0,1,0,1,0,1,0\n0,1,-1,1,1,1,0\n0,1,-1,1,-1,1,0\n1,1,1,1,-1,1,0\n"
              "0,1,0,1,0,1,0\n-1,1,1,1,1,1,0\n0,1,-1,1,-1,1,0\n1,1,-1,1,0,1,0\n",
              "tight_inclusion");
    EXPECT_EQ(answer(q), "0\n");
    q.max_checks = 2;
    EXPECT_EQ(answer(q), "1\n");
    q.max_checks.reset();
    q.tolerance = 10;
    EXPECT_EQ(answer(q), "1\n");
    q.tolerance = -1;
    EXPECT_THAT(complaint(q), HasSubstr("--tolerance is -1; it must be 0 or more"));
    q = query(near, "cubic_f64");
    q.tolerance = 1e-3;
    EXPECT_THAT(complaint(q), HasSubstr("--tolerance is a setting of --kernel tight_inclusion"));
    q = query(near);
    q.max_checks = 7;
    EXPECT_THAT(complaint(q), HasSubstr("--max-checks is a setting"));
}

TEST_F(QueryCcd, BadWordsAndFilesAreNamed) {
    CcdQuery q = query(falling("-1,1", "1"));
    q.kind = "vertex-fase";
    EXPECT_THAT(complaint(q), HasSubstr("'vertex-face'"));
    q.kind = "edge-edge";
    EXPECT_EQ(answer(q), "0\n");
    q.kernel = "tight_inklusion";
    EXPECT_THAT(complaint(q), HasSubstr("'tight_inclusion'"));
    q.kernel = "exact";
    q.queries += ".absent";
    EXPECT_THAT(complaint(q), HasSubstr("no such file"));
    EXPECT_THAT(complaint(query("1,2,3\n")), HasSubstr(".csv:1: 3 columns, expected 7"));
}

/// False answers of a kernel on the sample queries of Wang et al. 2021, by folder.
struct Wrong {
    int n = 0, false_positives = 0, false_negatives = 0;
};
const fs::path samples = "../shared/data/ccd";

std::map<std::string, Wrong> wrong_on_samples(const std::string& kernel) {
    std::map<std::string, Wrong> wrong;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(samples)) {
        if (entry.path().extension() != ".csv")
            continue;
        const fs::path kind = entry.path().parent_path().filename();
        CcdQuery query;
        query.queries = entry.path().string();
        query.kind = kind.string();
        query.kernel = kernel;
        std::ostringstream out;
        run(query, out);
        std::istringstream answers(out.str());
        Wrong& w = wrong[(entry.path().parent_path().parent_path().filename() / kind).string()];
        for (const CcdFileQuery& question :
             read_ccd_queries(read_text(query.queries), query.queries)) {
            int said = -1;
            answers >> said;
            ++w.n;
            w.false_positives += said == 1 && !question.touches;
            w.false_negatives += said == 0 && question.touches;
        }
    }
    return wrong;
}

TEST(QueryCcdSamples, ExactAndTightInclusionAreRightOnAll) {
    if (!fs::exists(samples))
        GTEST_SKIP() << samples << " is not there: the sample queries are no part of the project";
    for (const char* kernel : {"exact", "tight_inclusion"}) {
        int n = 0;
        for (const auto& [folder, wrong] : wrong_on_samples(kernel)) {
            n += wrong.n;
            EXPECT_EQ(wrong.false_negatives, 0) << kernel << " " << folder;
            // The published method (Tight-Inclusion, as in ipctk 1.6.1) has 4 in
            // erleben-wedges/edge-edge and none elsewhere.
            EXPECT_EQ(wrong.false_positives, 0) << kernel << " " << folder;
        }
        EXPECT_EQ(n, 1824);
    }
}

TEST(QueryCcdSamples, TheCubicMissesSome) {
    if (!fs::exists(samples))
        GTEST_SKIP() << samples << " is not there: the sample queries are no part of the project";
    EXPECT_GT(wrong_on_samples("cubic_f64").at("unit-tests/edge-edge").false_negatives, 0);
}

} // namespace
} // namespace boxwood::bench
