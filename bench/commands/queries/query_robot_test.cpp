#include "bench/commands/command.h"
#include "bench/commands/queries/query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Each link is one ball about its origin.
class BallsOfLinks final : public LinkNarrowPhase {
  public:
    explicit BallsOfLinks(const Robot& robot) : robot_(robot) {}
    bool collide(std::uint32_t a, std::uint32_t b,
                 std::span<const RigidTransform<double>> poses) const override {
        return apart(a, b, poses) <= 0;
    }
    LinkDistance distance(std::uint32_t a, std::uint32_t b,
                          std::span<const RigidTransform<double>> poses, double) const override {
        const double d = std::max(0.0, apart(a, b, poses));
        return {d, d, d};
    }

  private:
    double apart(std::uint32_t a, std::uint32_t b,
                 std::span<const RigidTransform<double>> poses) const {
        const auto radius = [&](std::uint32_t link) {
            return std::get<LinkSphere>(robot_.links()[link].geometries[0].shape).radius;
        };
        return length(poses[a].translation - poses[b].translation) - radius(a) - radius(b);
    }
    const Robot& robot_;
};

const MakeLinkNarrowPhase balls = [](const Robot& robot, std::span<const TriangleMesh>, bool) {
    return std::make_unique<BallsOfLinks>(robot);
};

/// Four balls in a row, one apart; the last two slide on rails towards the first ones.
const std::string four_balls = R"(<robot name="balls">
<link name="a"><collision><geometry><sphere radius=".25"/></geometry></collision></link>
<link name="b"><collision><geometry><sphere radius=".25"/></geometry></collision></link>
<link name="c"><collision><geometry><sphere radius=".25"/></geometry></collision></link>
<link name="d"><collision><geometry><sphere radius=".2"/></geometry></collision></link>
<joint name="ab" type="fixed"><parent link="a"/><child link="b"/><origin xyz="1 0 0"/></joint>
<joint name="bc" type="prismatic"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/>
<axis xyz="1 0 0"/><limit lower="-1" upper="1"/></joint>
<joint name="cd" type="prismatic"><parent link="c"/><child link="d"/><origin xyz="1 0 0"/>
<axis xyz="1 0 0"/><limit lower="-2" upper="1"/><mimic joint="bc" multiplier="2"/></joint>
</robot>)";

class QueryRobot : public ::testing::Test {
  protected:
    QueryRobot()
        : folder_(fs::temp_directory_path() /
                  ("boxwood_query_robot_" + std::to_string(std::random_device{}()))) {
        fs::create_directories(folder_);
        query_.files.urdf = put("balls.urdf", four_balls);
    }
    ~QueryRobot() override { fs::remove_all(folder_); }

    std::string put(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    std::string answer() const {
        std::ostringstream out;
        run(query_, balls, out);
        return out.str();
    }
    std::string complaint() const {
        try {
            return "answered: " + answer();
        } catch (const BadInput& e) {
            return e.what();
        }
    }
    fs::path folder_;
    RobotQuery query_;
};

TEST_F(QueryRobot, PrintsTheRobotAndItsStateAtRest) {
    EXPECT_EQ(answer(), "link,a,,1\nlink,b,a,1\nlink,c,b,1\nlink,d,c,1\n"
                        "joint,ab,fixed,,\njoint,bc,prismatic,-1,1\njoint,cd,prismatic,-2,1\n"
                        "allowed,a,b,adjacent\nallowed,b,c,adjacent\nallowed,c,d,adjacent\n"
                        "value,0,bc,0\nleast,0,a,c,1.5,1.5,1.5\n");
}

TEST_F(QueryRobot, JointsAreSetByName) {
    query_.joints = "bc=-1"; // c at 1, where b is; d, which mimics, at 0, where a is
    EXPECT_THAT(answer(),
                HasSubstr("value,0,bc,-1\ncandidate,0,a,d\ncandidate,0,b,c\nfiltered,0,a,d\n"
                          "colliding,0,a,d\nleast,0,a,d,0,0,0\n"));
    query_.joints = "bc=.5,";
    EXPECT_THAT(answer(), HasSubstr("value,0,bc,0.5\nleast"));
    ::testing::internal::CaptureStderr();
    query_.joints = "bc=1.5";
    EXPECT_THAT(answer(), HasSubstr("value,0,bc,1.5\n"));
    EXPECT_THAT(::testing::internal::GetCapturedStderr(),
                HasSubstr("warning: bc is 1.5, outside its limits -1 to 1\n"));
    for (const auto& [joints, words] : std::vector<std::pair<std::string, std::string>>{
             {"bc=1e30", "bc=1e30 is beyond 2^60"},
             {"bd=1", "unknown joint 'bd'"},
             {"cd=1", "mimics joint 'bc'"},
             {"bc=1m", "--joints: 'bc=1m' is no NAME=NUMBER"},
             {"bc=nan", "no NAME=NUMBER"},
             {"bc", "no NAME=NUMBER"},
             {"bc=1,bc=.5", "--joints: bc is named twice"}}) {
        query_.joints = joints;
        EXPECT_THAT(complaint(), HasSubstr(words));
    }
}

TEST_F(QueryRobot, JsonHoldsTheSame) {
    query_.joints = "bc=-1";
    query_.format.json = true;
    const std::string text = answer();
    EXPECT_THAT(text, StartsWith("{\"robot\":\"balls\",\"links\":[{\"name\":\"a\",\"parent\":null,"
                                 "\"geometries\":1},{\"name\":\"b\",\"parent\":\"a\""));
    EXPECT_THAT(text,
                HasSubstr("{\"name\":\"cd\",\"type\":\"prismatic\",\"parent\":\"c\",\"child\":"
                          "\"d\",\"lower\":-2,\"upper\":1,\"mimics\":\"bc\"}]"));
    EXPECT_THAT(text, HasSubstr("{\"links\":[\"b\",\"c\"],\"reason\":\"adjacent\",\"note\":\"\"}"));
    EXPECT_THAT(
        text, HasSubstr("\"states\":[{\"values\":{\"bc\":-1},\"candidate_pairs\":[[\"a\",\"d\"],["
                        "\"b\",\"c\"]],\"filtered_pairs\":[[\"a\",\"d\"]],\"colliding\":[[\"a\","
                        "\"d\"]],\"distance\":0,\"lo\":0,\"hi\":0,\"nearest\":[\"a\",\"d\"]}]}\n"));
}

TEST_F(QueryRobot, ObstaclesAreHitOrClear) {
    // Balls of .25 at 0, 1 and 2, and of .2 at 3; none of them is seen by another obstacle.
    query_.obstacles = {"box:1,1,1@2,.6,0", "sphere:.5@3,0,1", "sphere:.1@2,.6,0"};
    EXPECT_THAT(answer(),
                HasSubstr("hit,0,c,box:1,1,1@2,.6,0\nclearance,0,c,box:1,1,1@2,.6,0,0,0,"));
    query_.obstacles = {"sphere:.5@3,0,1"};
    EXPECT_THAT(answer(),
                AllOf(Not(HasSubstr("hit,")), HasSubstr("clearance,0,d,sphere:.5@3,0,1,0.3")));
    query_.format.json = true;
    EXPECT_THAT(answer(), HasSubstr("\"obstacles\":{\"hits\":[],\"distance\":0.3"));
    query_.obstacles = {"sphere:.5@3,0"};
    EXPECT_THAT(complaint(), HasSubstr("--obstacle sphere:.5@3,0"));
    query_.obstacles = {"ball:.5"};
    EXPECT_THAT(complaint(), HasSubstr("ball:.5: no such file"));
    query_.obstacles = {"d=sphere:.5"};
    EXPECT_THAT(complaint(), HasSubstr("--obstacle d=sphere:.5: a link is called d"));
    query_.obstacles = {(folder_ / "none.obj").string()};
    EXPECT_THAT(complaint(), HasSubstr("none.obj"));
    const std::string file = put("d", ""); // a link may be called as a file is
    query_.files.urdf = put("of_file.urdf", "<robot name='r'><link name='" + file + "'/></robot>");
    query_.obstacles = {file};
    EXPECT_THAT(complaint(),
                HasSubstr("a link is called " + file + "; give the obstacle another "));
}

TEST_F(QueryRobot, AnSrdfFileSaysWhatIsAllowedAndNamesStates) {
    query_.files.srdf = put("balls.srdf", "<robot><disable_collisions link1='d' link2='a' "
                                          "reason='Never'/><group_state name='in'><joint name='bc' "
                                          "value='-1'/><joint name='cd' value='-2'/></group_state>"
                                          "</robot>");
    query_.state = "in";
    EXPECT_THAT(answer(), AllOf(HasSubstr("allowed,a,d,never\nvalue,0,bc,-1\n"),
                                HasSubstr("filtered,0,b,c\ncolliding,0,b,c\n")));
    query_.state = "out";
    EXPECT_THAT(complaint(), HasSubstr("unknown state 'out'"));
    query_.state.reset();
    query_.files.srdf = put("nothing.srdf", "<robot/>");
    ::testing::internal::CaptureStderr();
    answer();
    EXPECT_THAT(::testing::internal::GetCapturedStderr(),
                HasSubstr("nothing.srdf allows no pair to collide, not even adjacent links"));
    query_.files.srdf = query_.files.urdf;
    EXPECT_THAT(complaint(), HasSubstr("this is a URDF file"));
    query_.files.srdf.reset();
    query_.state = "out";
    EXPECT_THAT(complaint(), HasSubstr("give one by --srdf"));
}

TEST_F(QueryRobot, StepsLeadFromEachRandomStateToTheNext) {
    query_.random = 3;
    const std::string waypoints = answer();
    const auto value = [](const std::string& text, int state) {
        const std::string key = "value," + std::to_string(state) + ",bc,";
        const std::size_t at = text.find(key);
        EXPECT_NE(at, std::string::npos) << state;
        return std::stod(text.substr(at + key.size()));
    };
    query_.steps = 4;
    query_.files.srdf.reset();
    query_.svg = (folder_ / "least.svg").string();
    const std::string text = answer();
    EXPECT_THAT(text, Not(HasSubstr("value,9,")));
    for (int i = 0; i <= 8; ++i) {
        const double from = value(waypoints, i / 4), to = value(waypoints, std::min(i / 4 + 1, 2));
        EXPECT_NEAR(value(text, i), from + (to - from) * (i % 4) / 4, 1e-12) << i;
    }
    std::ifstream file(*query_.svg);
    const std::string drawn((std::istreambuf_iterator<char>(file)), {});
    EXPECT_THAT(drawn,
                AllOf(StartsWith("<svg "), HasSubstr("9 states"), HasSubstr("class=\"least\"")));
    EXPECT_EQ(std::ranges::count(drawn, '<'), std::ranges::count(drawn, '>'));
    query_.svg = (folder_ / "nowhere" / "least.svg").string();
    EXPECT_THAT(complaint(), HasSubstr("cannot be written"));
}

TEST_F(QueryRobot, RandomStatesAreTheSameForASeed) {
    query_.random = 50;
    const std::string first = answer();
    EXPECT_EQ(answer(), first);
    EXPECT_THAT(first, HasSubstr("value,49,bc,"));
    EXPECT_THAT(first, Not(HasSubstr("value,50,")));
    query_.seed = 2;
    EXPECT_NE(answer(), first);
    query_.format.json = true;
    const std::string json = answer();
    EXPECT_EQ(std::ranges::count(json, '{'), std::ranges::count(json, '}'));
}

TEST_F(QueryRobot, SamplesProposePairsThatCanBeWritten) {
    query_.samples = 200;
    query_.write_srdf = (folder_ / "out.srdf").string();
    EXPECT_THAT(answer(), AllOf(HasSubstr("allowed,a,c,sampled"), Not(HasSubstr("allowed,a,d"))));
    query_.samples.reset();
    query_.files.srdf = query_.write_srdf;
    query_.write_srdf.reset();
    query_.format.json = true;
    EXPECT_THAT(answer(), HasSubstr("{\"links\":[\"a\",\"c\"],\"reason\":\"sampled\",\"note\":\"in "
                                    "none of 200 samples, seed 1\"}"));
    query_.write_srdf = "/nonexistent/out.srdf";
    EXPECT_THAT(complaint(), HasSubstr("cannot be written"));
    query_.write_srdf = query_.files.srdf; // which is read before it is replaced
    answer();
    query_.write_srdf.reset();
    EXPECT_THAT(answer(), HasSubstr("none of 200 samples"));
}

TEST_F(QueryRobot, BadFilesAreBadInput) {
    query_.files.urdf = (folder_ / "none.urdf").string();
    EXPECT_THAT(complaint(), HasSubstr("no such file"));
    query_.files.urdf = put("bad.urdf", "<robot>");
    EXPECT_THAT(complaint(), HasSubstr("bad.urdf:1:"));
    query_.files.urdf = put("balls.urdf", four_balls);
    query_.files.srdf = put("bad.srdf", "<robot><disable_collisions link1='x' link2='a'/></robot>");
    EXPECT_THAT(complaint(), HasSubstr("bad.srdf:1:"));
}

TEST_F(QueryRobot, SharedPandaIsReadWithItsPairs) {
    const fs::path panda = "../shared/data/robots/panda";
    if (!fs::is_directory(panda))
        GTEST_SKIP() << panda << " is not here: the sample robots are no part of the project";
    query_.files.urdf = (panda / "panda.urdf").string();
    query_.files.srdf = (panda / "panda.srdf").string();
    query_.state = "ready";
    /// Boxes alone: whatever it is asked about collides.
    class Boxes final : public LinkNarrowPhase {
        bool collide(std::uint32_t, std::uint32_t,
                     std::span<const RigidTransform<double>>) const override {
            return true;
        }
        LinkDistance distance(std::uint32_t, std::uint32_t, std::span<const RigidTransform<double>>,
                              double) const override {
            return {0, 0, 0};
        }
    };
    std::ostringstream out;
    run(
        query_, [](const Robot&, auto, bool) { return std::make_unique<Boxes>(); }, out);
    const std::string text = out.str();
    EXPECT_THAT(text, AllOf(HasSubstr("link,panda_link8,panda_link7,0\n"),
                            HasSubstr("allowed,panda_link0,panda_link1,adjacent\n"),
                            HasSubstr("value,0,panda_joint4,-2.356\n"),
                            HasSubstr("candidate,0,panda_link1,panda_link2\n"),
                            Not(HasSubstr("filtered,0,panda_link1,panda_link2\n"))));

    // The adjacent links that are proposed are those that MoveIt found.
    const auto adjacent = [](const std::string& lines) {
        std::vector<std::string> found;
        std::istringstream in(lines);
        for (std::string line; std::getline(in, line);)
            if (line.ends_with(",adjacent"))
                found.push_back(line);
        return found;
    };
    query_.files.srdf.reset();
    query_.state.reset();
    std::ostringstream proposed;
    run(
        query_, [](const Robot&, auto, bool) { return std::make_unique<Boxes>(); }, proposed);
    EXPECT_EQ(adjacent(text).size(), 10u);
    EXPECT_EQ(adjacent(proposed.str()), adjacent(text));
}

} // namespace
} // namespace boxwood::bench
