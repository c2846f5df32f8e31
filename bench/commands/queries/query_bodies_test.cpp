/// What the queries of bodies take and say beside their answers, through the command line.

#include "bench/commands/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* cube = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\n"
                             "v -1 1 1\nv 1 1 1\nf 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\n"
                             "f 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n";

class QueryBodies : public ::testing::Test {
  protected:
    QueryBodies()
        : folder_(std::filesystem::temp_directory_path() /
                  ("boxwood_bodies_" + std::to_string(std::random_device{}()))) {
        std::filesystem::create_directories(folder_);
    }
    ~QueryBodies() override { std::filesystem::remove_all(folder_); }

    std::string put(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }

    struct Said {
        int code;
        std::string out, err;
    };
    static Said query(std::vector<std::string> words) {
        words.insert(words.begin(), {"boxwood", "query"});
        std::vector<char*> argv;
        for (std::string& word : words)
            argv.push_back(word.data());
        ::testing::internal::CaptureStdout();
        ::testing::internal::CaptureStderr();
        const int code = run_program(static_cast<int>(argv.size()), argv.data());
        std::cout.flush();
        std::string out = ::testing::internal::GetCapturedStdout();
        return {code, std::move(out), ::testing::internal::GetCapturedStderr()};
    }
    static std::string at(double x, double y, double z) {
        std::ostringstream text;
        text.precision(17);
        text << "1 0 0 " << x << " 0 1 0 " << y << " 0 0 1 " << z << " 0 0 0 1";
        return text.str();
    }
    static double distance(const std::string& a, const std::string& b, double x, double y,
                           double z) {
        const Said said = query({"distance", a, b, "--pose-b", at(x, y, z)});
        EXPECT_EQ(said.code, 0) << said.err;
        return std::strtod(said.out.c_str(), nullptr);
    }

    std::filesystem::path folder_;
};

TEST_F(QueryBodies, TimesAreSaidOnRequestAlone) {
    const std::string mesh = put("cube.obj", cube);
    for (const std::string question :
         {"collide", "distance", "tolerance", "contacts", "continuous"}) {
        std::vector<std::string> words{question, mesh, "sphere:.5"};
        if (question == "tolerance")
            words.insert(words.end(), {"--tolerance", "1"});
        const Said plain = query(words);
        EXPECT_EQ(plain.code, 0) << plain.err;
        EXPECT_EQ(plain.err, "") << question;
        words.push_back("--times");
        const Said timed = query(words);
        EXPECT_EQ(timed.out, plain.out) << question;
        EXPECT_THAT(timed.err, ::testing::MatchesRegex(
                                   "boxwood: read in .*s, trees built in .*s, answered in .*s "
                                   "\\(median of [0-9]+ runs?; the first took .*s\\)\n"))
            << question;
        words.push_back("--json");
        const Said json = query(words);
        EXPECT_EQ(json.err, "") << question;
        double read = 0, build = 0, first = 0, median = 0;
        std::size_t runs = 0;
        const std::size_t from = json.out.find(",\"read_seconds\":");
        ASSERT_NE(from, std::string::npos) << json.out;
        ASSERT_EQ(std::sscanf(json.out.c_str() + from,
                              ",\"read_seconds\":%lf,\"build_seconds\":%lf,\"first_query_seconds\":"
                              "%lf,\"query_seconds\":%lf,\"query_runs\":%zu}",
                              &read, &build, &first, &median, &runs),
                  5)
            << json.out;
        EXPECT_GT(read, 0);
        EXPECT_GT(build, 0);
        EXPECT_GT(first, 0);
        EXPECT_GT(median, 0);
        EXPECT_LT(median, .2);
        EXPECT_GE(runs, 1u);
    }
}

/// Distances along an axis that anybody can compute.
TEST_F(QueryBodies, EveryFormIsWhatItSays) {
    EXPECT_NEAR(distance("sphere:1", "cone:1,4", 0, 0, 6), 3, 1e-9);  // its base is at 4
    EXPECT_NEAR(distance("sphere:1", "cone:1,4", 0, 0, -6), 3, 1e-9); // its tip at -4
    EXPECT_NEAR(distance("box:2,2,2", "cone:2,2", 5, 0, 0), 2, 1e-9); // its base's side at 3
    EXPECT_NEAR(distance("sphere:1", "ellipsoid:1,2,3", 0, 9, 0), 6, 1e-9);
    EXPECT_NEAR(distance("sphere:1", "half_space:0,0,2,-6", 0, 0, 0), 2, 1e-9); // z <= -3
    EXPECT_NEAR(distance("sphere:1", "half-space:0,0,1,-3", 0, 0, -1), 3, 1e-9);
    EXPECT_EQ(distance("sphere:1", "half_space:0,0,1,7", 0, 0, 0), 0);
    EXPECT_NEAR(distance("sphere:1", "plane:1,0,0,7", 0, 0, 0), 6, 1e-9);
    const std::string mesh = put("cube.obj", cube);
    EXPECT_NEAR(distance(mesh, "plane:0,1,0,4", 0, 0, 0), 3, 1e-9);
    EXPECT_NEAR(distance("half_space:0,0,1,-3", mesh, 0, 0, 0), 2, 1e-9);
    // The hull of two cubes' corners is what is between them, too.
    std::string shifted;
    for (const char* vertex : {"v 9 -1 -1\n", "v 9 1 -1\n", "v 9 1 1\n"})
        shifted += vertex;
    const std::string two = put("two.obj", std::string(cube) + shifted + "f 9 10 11\n");
    EXPECT_EQ(distance("hull:" + two, "sphere:.1", 5, 0, 0), 0);
    EXPECT_NEAR(distance(two, "sphere:.1", 5, 0, 0), 3.9, 1e-9);
    EXPECT_NEAR(distance("hull:" + two, "sphere:.1", 5, 0, -3), 1.9, 1e-9);
    const std::string cloud = put("cloud.csv", "x,y,z\n0,0,0\n# apart\n0,0,4\n");
    EXPECT_NEAR(distance("points:.5," + cloud, mesh, 0, 0, 7), 1.5, 1e-9);
    EXPECT_NEAR(distance("sphere:.25", "points:.5," + cloud, 1, 0, 0), .25, 1e-9);
    // A box is solid beside points: one in its middle touches it.
    EXPECT_EQ(distance("box:9,9,9", "points:.1," + cloud, 0, 0, 0), 0);
    const std::string ground = put("ground.csv", "0,0,0\n0,2,0\n0,0,0\n");
    EXPECT_NEAR(distance("height_field:1,1," + ground, "sphere:.5", 1, 1, 5), 2.5, 1e-9);
    const Said ids =
        query({"distance", "points:.5," + cloud, mesh, "--pose-b", at(0, 0, 7), "--json"});
    EXPECT_THAT(ids.out, HasSubstr("\"triangle_a\":1,"));
}

TEST_F(QueryBodies, BadFormsAreRefused) {
    const auto complaint = [](const std::string& body) {
        const Said said = query({"collide", body, "sphere:1"});
        EXPECT_EQ(said.code, 2) << body;
        return said.err;
    };
    EXPECT_THAT(complaint("cone:1"), HasSubstr("cone:radius,length"));
    EXPECT_THAT(complaint("elipsoid:1,1,1"), HasSubstr("did you mean 'ellipsoid'?"));
    EXPECT_THAT(complaint("half_space:0,0,0,1"), HasSubstr("its normal is 0"));
    EXPECT_THAT(complaint("plane:0,0,inf,1"), HasSubstr("not finite"));
    EXPECT_THAT(complaint("hull:"), HasSubstr("it is hull:FILE"));
    EXPECT_THAT(complaint("hull:/nowhere.obj"), HasSubstr("/nowhere.obj"));
    EXPECT_THAT(complaint("points:1,/nowhere.csv"), HasSubstr("/nowhere.csv"));
    EXPECT_THAT(complaint("points:-1," + put("p.csv", "0,0,0\n")), HasSubstr("at least 0"));
    EXPECT_THAT(complaint("points:1," + put("none.csv", "# nothing\n")), HasSubstr("no point"));
    EXPECT_THAT(complaint("height_field:1,1," + put("h.csv", "0,1\n0,1,2\n")),
                HasSubstr("h.csv:2: 3 heights; the rows before have 2"));
    EXPECT_THAT(complaint("height_field:1,1," + put("x.csv", "0,x\n")),
                HasSubstr("x.csv:1: column 2"));
    EXPECT_THAT(complaint("height_field:1,1," + put("i.csv", "0,inf\n")),
                HasSubstr("no finite float"));
}

/// Two noisy pairs of plates: the answer stays in its bounds and within what was allowed.
TEST_F(QueryBodies, DistancesMayBeRough) {
    std::string bumps;
    for (int j = 0; j < 40; ++j)
        for (int i = 0; i < 40; ++i)
            bumps += (i ? "," : "") + std::to_string(std::sin(i * 1.7 + j * 2.3) * .3) +
                     (i == 39 ? "\n" : "");
    const std::string field = "height_field:.1,.1," + put("bumps.csv", bumps);
    const auto bounds = [&](std::vector<std::string> more) {
        std::vector<std::string> words{"distance", field, field, "--pose-b", at(.03, .02, 1)};
        words.insert(words.end(), more.begin(), more.end());
        double d = 0, lo = 0, hi = 0;
        const Said said = query(words);
        EXPECT_EQ(std::sscanf(said.out.c_str(), "%lf,%lf,%lf", &d, &lo, &hi), 3) << said.err;
        EXPECT_TRUE(lo <= d && d <= hi);
        return std::pair(lo, hi);
    };
    const auto [lo, hi] = bounds({});
    EXPECT_LT(hi - lo, 1e-9);
    const auto [rough_lo, rough_hi] = bounds({"--relative", ".5"});
    EXPECT_LE(rough_lo, hi);
    EXPECT_GE(rough_hi, lo);
    EXPECT_LE(rough_hi, rough_lo / .5 * (1 + 1e-9));
    EXPECT_GT(rough_hi - rough_lo, 1e-6) << "nothing is saved";
    const auto [near_lo, near_hi] = bounds({"--absolute", ".25"});
    EXPECT_LE(near_lo, hi);
    EXPECT_LE(near_hi, near_lo + .25 * (1 + 1e-9));
    EXPECT_GT(near_hi - near_lo, 1e-6);
    for (const std::vector<std::string>& bad : {std::vector<std::string>{"--relative", "1"},
                                                {"--absolute", "-1"},
                                                {"--relative", "nan"},
                                                {"--relative", ".1", "--signed"}}) {
        std::vector<std::string> words{"distance", "sphere:1", "sphere:2"};
        words.insert(words.end(), bad.begin(), bad.end());
        EXPECT_EQ(query(words).code, 2);
    }
}

/// The same answer from either tree, the slower one of which takes its time somewhere.
TEST_F(QueryBodies, VolumesAreChosenByName) {
    const std::string mesh = put("cube.obj", cube);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"distance", mesh, "sphere:.5", "--pose-b", at(3, 2, 1)},
          {"collide", mesh, mesh, "--solid"},
          {"continuous", mesh, "sphere:1", "--from-b", at(4, 0, 0), "--to-b", at(0, 0, 0)}}) {
        std::vector<std::string> of_aabb = words;
        of_aabb.insert(of_aabb.end(), {"--volume", "aabb"});
        const Said said = query(of_aabb);
        EXPECT_EQ(said.code, 0) << said.err;
        EXPECT_EQ(said.out, query(words).out);
    }
    const Said unknown = query({"collide", mesh, mesh, "--volume", "sphere"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(unknown.err, HasSubstr("obb"));
}

TEST_F(QueryBodies, WhatBeginsInsideASolidTouchesAtOnce) {
    const std::string mesh = put("cube.obj", cube);
    for (const char* inner : {"sphere:.1", "box:.25,.25,.25", "box:.2,.2,.2"}) {
        std::vector<std::string> words{"continuous", mesh, inner, "--to-b", at(5, 0, 0)};
        const Said surface = query(words);
        EXPECT_THAT(surface.out, Not(StartsWith("1,0,0\n"))) << inner;
        EXPECT_THAT(surface.out, StartsWith("1,0")) << inner;
        words.push_back("--solid");
        EXPECT_EQ(query(words).out, "1,0,0\n") << inner;
        words.insert(words.end(), {"--from-b", at(5, 0, 0)}); // and stays there
        EXPECT_EQ(query(words).out, "0,1,1\n") << inner;
    }
    const std::string open = put("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Said refused = query({"continuous", open, "sphere:1", "--solid"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("open.obj: the mesh is no solid"));
}

/// Triangles 12 to 15 of these are bad.
TEST_F(QueryBodies, BadTrianglesAreReportedAndSetAside) {
    const std::string bad = put("bad.obj", std::string(cube) + "v nan 0 0\nv 0 0 5\nv 0 0 6\n"
                                                               "f 1 2 9\nf 10 10 11\nf 1 3 4\n"
                                                               "f 2 6 8\n");
    std::vector<std::string> words{"distance", bad, "sphere:.5", "--pose-b", at(0, 0, 8)};
    const Said kept = query(words);
    EXPECT_EQ(kept.code, 0);
    EXPECT_NEAR(std::strtod(kept.out.c_str(), nullptr), 1.5, 1e-9); // to the segment
    EXPECT_THAT(kept.err, HasSubstr("bad.obj: bad triangles: 1 with a NaN or inf (triangle 12), 1 "
                                    "without area (triangle 13), 2 repeated (the first: triangle "
                                    "14); 1 of 16 triangles is set aside\n"));
    words.insert(words.end(), {"--bad-triangles", "set-aside"});
    const Said aside = query(words);
    EXPECT_NEAR(std::strtod(aside.out.c_str(), nullptr), 6.5, 1e-9);
    EXPECT_THAT(aside.err, HasSubstr("4 of 16 triangles are set aside"));
    words.back() = "refuse";
    const Said refused = query(words);
    EXPECT_EQ(refused.code, 2);
    EXPECT_EQ(refused.out, "");
    EXPECT_THAT(refused.err, HasSubstr("1 without area"));
    // Closed only without them: --solid just works.
    EXPECT_EQ(query({"collide", bad, "sphere:.1"}).out, "0\n");
    const Said solid = query({"collide", bad, "sphere:.1", "--solid"});
    EXPECT_EQ(solid.out, "1\n");
    EXPECT_THAT(solid.err, HasSubstr("4 of 16 triangles are set aside, as the mesh is closed"));
    EXPECT_EQ(query({"distance", put("cube.obj", cube), "sphere:.1"}).err, "");
}

/// Triangles keep the numbers of the file when others before them are set aside.
TEST_F(QueryBodies, TrianglesKeepTheirNumbers) {
    const std::string mesh =
        put("late.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 2 3 4\n");
    const Said found = query({"collide", mesh, "sphere:9", "--json"});
    EXPECT_THAT(found.out, HasSubstr("\"triangle_pairs\":[[2,null]]"));
    const Said near = query({"distance", "sphere:.1", mesh, "--json"});
    EXPECT_THAT(near.out, HasSubstr("\"triangle_b\":2,"));
    const Said both = query({"collide", mesh, mesh, "--json"});
    EXPECT_THAT(both.out, HasSubstr("\"triangle_pairs\":[[2,2]]"));
}

/// A shell, which is the cube of half side 1, about a ball; and a link apart from them.
constexpr const char* shell = R"(<robot name="shell">
<link name="shell"><collision><geometry><mesh filename="cube.obj"/></geometry></collision></link>
<link name="core"><collision><geometry><sphere radius=".1"/></geometry></collision></link>
<link name="arm"><collision><geometry><sphere radius=".5"/></geometry></collision></link>
<joint name="a" type="fixed"><parent link="shell"/><child link="arm"/><origin xyz="4 0 0"/></joint>
<joint name="c" type="fixed"><parent link="arm"/><child link="core"/><origin xyz="-4 0 0"/></joint>
</robot>)";

TEST_F(QueryBodies, LinksOfARobotAreSolidOnRequest) {
    put("cube.obj", cube);
    const std::string urdf = put("shell.urdf", shell);
    EXPECT_THAT(query({"robot", urdf}).out,
                ::testing::AllOf(Not(HasSubstr("colliding")), HasSubstr("least,0,shell,core,0.9")));
    const Said solid = query({"robot", urdf, "--solid"});
    EXPECT_THAT(solid.out, HasSubstr("colliding,0,shell,core\nleast,0,shell,core,0,0,0\n"));
    EXPECT_THAT(
        query({"robot", urdf, "--solid", "--allow", "core,shell"}).out,
        ::testing::AllOf(HasSubstr("allowed,shell,core,user\n"), Not(HasSubstr("colliding"))));
    // What stands around it, too.
    const std::vector<std::string> inside{"robot", urdf, "--obstacle", "sphere:.1@.5,0,0"};
    EXPECT_THAT(query(inside).out, Not(HasSubstr("hit,0,shell")));
    std::vector<std::string> of_solid = inside;
    of_solid.push_back("--solid");
    EXPECT_THAT(query(of_solid).out, HasSubstr("hit,0,shell,sphere:.1@.5,0,0\n"));
    put("cube.obj", std::string(cube).substr(0, std::string(cube).rfind("f ")));
    const Said open = query({"robot", urdf, "--solid"});
    EXPECT_THAT(open.err, HasSubstr("cube.obj: 3 edges belong to an odd number of triangles"));
    EXPECT_THAT(open.out, Not(HasSubstr("colliding")));
}

TEST_F(QueryBodies, ObstaclesHaveNamesAndPosesAndMayBeAllowed) {
    put("cube.obj", cube);
    const std::string urdf = put("shell.urdf", shell);
    // A rod along z, turned to lie along y above the arm's ball: 1 - .5 - .1 away.
    const std::string rod = "rod=capsule:.1,3@1 0 0 4  0 0 1 0  0 -1 0 1  0 0 0 1";
    const Said apart = query({"robot", urdf, "--obstacle", rod});
    EXPECT_EQ(apart.code, 0) << apart.err;
    const std::size_t at = apart.out.find("clearance,0,arm,rod,");
    ASSERT_NE(at, std::string::npos) << apart.out;
    EXPECT_NEAR(std::strtod(apart.out.c_str() + at + 20, nullptr), .4, 1e-9);
    // Upright it would go through it; along y at a height of .3 it does, too.
    const std::string low = "rod=capsule:.1,3@1 0 0 4  0 0 1 0  0 -1 0 .3  0 0 0 1";
    EXPECT_THAT(query({"robot", urdf, "--obstacle", low}).out, HasSubstr("hit,0,arm,rod\n"));
    const Said allowed = query({"robot", urdf, "--obstacle", low, "--allow", "arm,rod"});
    EXPECT_THAT(allowed.out, Not(HasSubstr("hit,")));
    EXPECT_THAT(allowed.out, HasSubstr("clearance,0,shell,rod,"));
    // Without a NAME an obstacle is what was written.
    const std::string ball = "sphere:.2@4,0,0";
    EXPECT_THAT(query({"robot", urdf, "--obstacle", ball}).out, HasSubstr("hit,0,arm," + ball));
    EXPECT_THAT(query({"robot", urdf, "--obstacle", ball, "--allow", "arm," + ball}).out,
                Not(HasSubstr("hit,")));
    const auto complaint = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"robot", urdf});
        const Said said = query(more);
        EXPECT_EQ(said.code, 2) << said.out;
        return said.err;
    };
    EXPECT_THAT(complaint({"--allow", "arm"}), HasSubstr("LINK,LINK or LINK,OBSTACLE"));
    EXPECT_THAT(complaint({"--allow", "amr,shell"}), HasSubstr("did you mean 'arm'?"));
    EXPECT_THAT(complaint({"--allow", "arm,arm"}), HasSubstr("one link"));
    EXPECT_THAT(complaint({"--obstacle", rod, "--allow", "arm,rad"}),
                HasSubstr("unknown link or obstacle 'rad'; did you mean 'rod'?"));
    EXPECT_THAT(complaint({"--obstacle", rod, "--obstacle", low}),
                HasSubstr("another one is called rod"));
    EXPECT_THAT(complaint({"--obstacle", "sphere:1@1,2,3,4"}),
                HasSubstr("4 numbers; it takes x,y,z"));
    EXPECT_THAT(complaint({"--obstacle", "sphere:1@2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1"}),
                HasSubstr("no rigid transform"));
}

TEST_F(QueryBodies, RobotsAreTimedByState) {
    put("cube.obj", cube);
    const std::string urdf = put("shell.urdf", shell);
    const Said plain = query({"robot", urdf, "--random", "3", "--obstacle", "plane:0,0,1,-9"});
    const Said timed =
        query({"robot", urdf, "--random", "3", "--obstacle", "plane:0,0,1,-9", "--times"});
    EXPECT_EQ(timed.out, plain.out);
    EXPECT_THAT(timed.err, HasSubstr("boxwood: read in "));
    EXPECT_THAT(plain.err, Not(HasSubstr("read in")));
    const Said json = query({"robot", urdf, "--times", "--json"});
    EXPECT_THAT(json.out, ::testing::ContainsRegex("\\],\"read_seconds\":[0-9.e-]+,.*"
                                                   "\"query_runs\":[0-9]+}\n"));
    EXPECT_THAT(json.err, Not(HasSubstr("read in")));
}

} // namespace
} // namespace boxwood::bench
