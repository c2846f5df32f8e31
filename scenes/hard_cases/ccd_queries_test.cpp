#include "kernels/oracle/rational.h"
#include "kernels/testing/complaint.h"
#include "scenes/hard_cases/hard_cases.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

namespace boxwood {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

/// A vertex that falls through a face at rest.
constexpr const char* falling = "1,4,1,4,1,1,1\n"
                                "0,1,0,1,0,1,1\n"
                                "1,1,0,1,0,1,1\n"
                                "0,1,1,1,0,1,1\n"
                                "1,4,1,4,-1,2,1\n"
                                "0,1,0,1,0,1,1\n"
                                "1,1,0,1,0,1,1\n"
                                "0,1,1,1,0,1,1\n";

/// A folder that goes away with it.
struct Folder {
    fs::path path =
        fs::temp_directory_path() /
        fmt::format("boxwood_ccd_{}", std::chrono::steady_clock::now().time_since_epoch().count());

    Folder() { fs::create_directories(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path); }

    fs::path write(const fs::path& name, const std::string& text) const {
        fs::create_directories((path / name).parent_path());
        std::ofstream(path / name) << text;
        return path / name;
    }
};

MotionCases read(const char* family, const fs::path& file) {
    HardCaseSpec spec;
    spec.file = file;
    return std::get<MotionCases>(make_cases(*find_hard_case_family(family), spec));
}

std::string error_of(const fs::path& file) {
    return complaint_of<std::runtime_error>([&] { read("ccd_queries_vertex_face", file); });
}

TEST(CcdQueries, ReadsStartThenEnd) {
    const Folder folder;
    const fs::path file = folder.write("a.csv", fmt::format("# a comment\r\n\n{}", falling));
    const MotionCases cases = read("ccd_queries_vertex_face", file);
    EXPECT_EQ(cases.kind, MotionKind::vertex_face);
    ASSERT_EQ(cases.motions.size(), 1u);
    const LinearMotion expected{{{{.25, .25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                                {{{.25, .25, -.5}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}};
    EXPECT_EQ(cases.motions[0].motion, expected);
    EXPECT_EQ(cases.motions[0].touch, Known::yes);
    EXPECT_EQ(read("ccd_queries_edge_edge", file).kind, MotionKind::edge_edge);
}

TEST(CcdQueries, AFolderGivesTheFilesOfItsKindInOrder) {
    const Folder folder;
    const std::string text = falling;
    std::string miss = text;
    for (std::size_t at = 0; (at = miss.find(",1\n", at)) != std::string::npos; at += 3)
        miss.replace(at, 3, ",0\n");
    folder.write("b/vertex-face/x.csv", text);
    folder.write("a/vertex-face/x.csv", miss);
    folder.write("a/vertex-face/notes.txt", "not a query");
    folder.write("a/edge-edge/x.csv", text + text);
    const MotionCases faces = read("ccd_queries_vertex_face", folder.path);
    ASSERT_EQ(faces.motions.size(), 2u);
    EXPECT_EQ(faces.motions[0].touch, Known::no);
    EXPECT_EQ(faces.motions[1].touch, Known::yes);
    EXPECT_EQ(read("ccd_queries_edge_edge", folder.path).motions.size(), 2u);
    EXPECT_EQ(read("ccd_queries_vertex_face", folder.path / "b" / "vertex-face").motions.size(),
              1u);
    EXPECT_THAT(error_of(folder.write("c/other/x.csv", text).parent_path()),
                HasSubstr("no *.csv in a folder named vertex-face"));
}

TEST(CcdQueries, ErrorsNameFileAndLine) {
    const Folder folder;
    const std::string text = falling;
    const auto error = [&](const std::string& content) {
        return error_of(folder.write("bad.csv", content));
    };
    EXPECT_THAT(error("1,3,0,1,0,1,1\n"), AllOf(HasSubstr("bad.csv:1: "), HasSubstr("1/3 is not")));
    EXPECT_THAT(error(text + "#\n0,1,0,1\n"),
                AllOf(HasSubstr(":10: "), HasSubstr("not 7 numbers")));
    EXPECT_THAT(error("0,1,0,1,0,1,1,1\n"), HasSubstr("not 7 numbers"));
    EXPECT_THAT(error("0,1,0,1,0,1,2\n"), HasSubstr("must be 0 or 1"));
    EXPECT_THAT(error("0,1,0,1,0,1,1\n0,1,0,1,0,1,0\n"),
                AllOf(HasSubstr(":2: "), HasSubstr("differs from")));
    EXPECT_THAT(error(text.substr(0, text.size() / 2)), HasSubstr("has 4 of 8 rows"));
    EXPECT_THAT(error("# nothing\n"), HasSubstr("no query"));
    EXPECT_THAT(error_of(folder.path / "missing.csv"), HasSubstr("no such file"));
}

// The published sets, should they lie beside the project: two readers of the truth agree on all.
TEST(CcdQueries, ThePublishedTruthIsWhatTheOracleSays) {
    const fs::path folder = "../shared/data/ccd";
    if (!fs::exists(folder))
        GTEST_SKIP() << fs::absolute(folder).lexically_normal()
                     << " is not there: the sample queries are no part of the project";
    const oracle::ExactContinuous exact;
    const MotionCases faces = read("ccd_queries_vertex_face", folder);
    const MotionCases edges = read("ccd_queries_edge_edge", folder);
    EXPECT_GT(faces.motions.size(), 900u);
    EXPECT_GT(edges.motions.size(), 800u);
    for (const MotionCase& c : faces.motions)
        EXPECT_EQ(exact.vertex_face(c.motion).answer == Answer::yes, c.touch == Known::yes);
    for (const MotionCase& c : edges.motions)
        EXPECT_EQ(exact.edge_edge(c.motion).answer == Answer::yes, c.touch == Known::yes);
}

} // namespace
} // namespace boxwood
