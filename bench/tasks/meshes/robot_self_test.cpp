#include "bench/tasks/detail/robot_in_scene.h"
#include "bench/tasks/task.h"
#include "bench/truth/truth.h"
#include "scenes/robots/robot_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

/// A base and three links, each on a hinge at the end of the one before.
std::string arm(const std::string& tip, const std::string& base = "<box size=\"1 1 1\"/>") {
    const auto link = [](const std::string& name, const std::string& shape) {
        return "<link name=\"" + name + "\"><collision><origin xyz=\"0 0 0.5\"/><geometry>" +
               shape + "</geometry></collision></link>\n";
    };
    const auto joint = [](const std::string& name, const std::string& parent,
                          const std::string& child, const std::string& axis) {
        return "<joint name=\"" + name + "\" type=\"revolute\"><parent link=\"" + parent +
               "\"/><child link=\"" + child +
               "\"/><origin xyz=\"0 0 1.1\"/>"
               "<axis xyz=\"" +
               axis + "\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"1\"/></joint>\n";
    };
    const std::string box = "<box size=\"0.2 0.3 1\"/>";
    const std::string mesh = "<mesh filename=\"robot_self_pyramid.obj\" scale=\"0.3 -0.4 0.5\"/>";
    return "<robot name=\"arm\">" + link("base", base) + link("lower", box) + link("upper", mesh) +
           link("tip", tip) + joint("a", "base", "lower", "1 0 0") +
           joint("b", "lower", "upper", "0 1 0") + joint("c", "upper", "tip", "1 0 1") + "</robot>";
}

struct RobotSelf : testing::Test {
    const Task& task = *find_task("robot_self");
    fs::path folder;
    SceneSpec spec{.generator = "robot", .n = 4, .n_poses = 200};

    void SetUp() override {
        std::string name = fs::path(testing::TempDir()) / "robot_self_XXXXXX";
        ASSERT_TRUE(mkdtemp(name.data()));
        folder = name;
        spec.file = folder / "robot_self_arm.urdf";
        std::ofstream(folder / "robot_self_pyramid.obj")
            << "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv 0 0 1\n"
               "f 1 3 2\nf 1 4 3\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
        std::ofstream(spec.file) << arm("<box size=\"0.2 0.2 1\"/>");
    }
    void TearDown() override { fs::remove_all(folder); }
    std::vector<ContenderEntry> contenders() const {
        std::vector<ContenderEntry> all = peers_that_answer(task.name());
        all.push_back(task.contender({}));
        return all;
    }
    /// How many states collide, if all agree with the truth.
    std::size_t agreed(const Scene& scene) const {
        const auto truth = task.make_truth(scene, 2);
        std::size_t hits = 0;
        for (const ContenderEntry& entry : contenders()) {
            const auto contender = entry.make({&scene, &task});
            AnswerList<std::uint8_t> answers;
            for (int again = 0; again < 2; ++again) {
                contender->build();
                contender->query(answers);
            }
            const Judgement judged = truth->judge(answers, entry);
            EXPECT_EQ(judged.status, Status::exact) << entry.name << ": " << judged.check.witness;
            hits = static_cast<std::size_t>(std::ranges::count(answers.list, std::uint8_t{1}));
        }
        return hits;
    }
};

TEST_F(RobotSelf, IsAnsweredAsTheTruthSays) {
    const Scene scene = make_scene(spec);
    ASSERT_FALSE(task.missing(scene));
    EXPECT_EQ(task.n_queries(scene), 200u);
    const std::size_t hits = agreed(scene);
    EXPECT_GT(hits, 10u);
    EXPECT_LT(hits, 190u);
    // A pair that an SRDF file allows is left out; then adjacent ones are not.
    std::ofstream(fs::path(spec.file).replace_extension(".srdf"))
        << "<robot name=\"arm\"><disable_collisions link1=\"base\" link2=\"tip\" "
           "reason=\"User\"/></robot>";
    EXPECT_NE(agreed(make_scene(spec)), hits);
}

TEST_F(RobotSelf, TheTruthSeesWhatIsWrong) {
    const Scene scene = make_scene(spec);
    const auto truth = task.make_truth(scene, 1);
    const ContenderEntry ours = task.contender({});
    const auto contender = ours.make({&scene, &task});
    AnswerList<std::uint8_t> right;
    contender->build();
    contender->query(right);
    for (const bool said : {false, true}) {
        AnswerList<std::uint8_t> wrong;
        wrong.list = right.list;
        *std::ranges::find(wrong.list, said ? 0 : 1) = said ? 1 : 0;
        const Judgement judged = truth->judge(wrong, ours);
        EXPECT_EQ(judged.check.missing, said ? 0u : 1u);
        EXPECT_EQ(judged.check.extra, said ? 1u : 0u);
        EXPECT_NE(judged.check.witness.find(said ? "no two links touch" : " and "),
                  std::string::npos);
    }
}

/// Solid, as each library has them: what lies in one touches it.
TEST_F(RobotSelf, IsAnsweredOfRoundLinksToo) {
    for (const char* tip : {"<cylinder radius=\"0.2\" length=\"1\"/>", "<sphere radius=\"0.4\"/>",
                            "<capsule radius=\"0.1\" length=\"0.8\"/>"}) {
        SCOPED_TRACE(tip);
        std::ofstream(spec.file) << arm(tip);
        EXPECT_GT(agreed(make_scene(spec)), 10u);
    }
}

/// Its box has no volume in any state, for which Coal's manager throws.
TEST_F(RobotSelf, IsAnsweredOfAFlatBaseToo) {
    std::ofstream(spec.file) << arm("<box size=\"0.2 0.2 1\"/>", "<box size=\"1 1 0\"/>");
    EXPECT_GT(agreed(make_scene(spec)), 10u);
}

TEST_F(RobotSelf, WantsARobotAndItsOwnBuilder) {
    EXPECT_TRUE(task.missing(make_scene({.generator = "sphere_mesh", .n = 100})));
    Choice choice;
    choice.builder = "lbvh";
    EXPECT_THROW(task.contender(choice), std::invalid_argument);
}

struct RobotDistance : RobotSelf {
    const Task& distances = *find_task("robot_distance");
    const ContenderEntry ours = distances.contender({});

    AnswerList<StateDistance> answers_of(const Scene& scene) const {
        const auto contender = ours.make({&scene, &distances});
        AnswerList<StateDistance> answers;
        contender->build();
        contender->query(answers);
        return answers;
    }
};

TEST_F(RobotDistance, IsAnsweredAsTheTruthSays) {
    for (const char* tip : {"<box size=\"0.2 0.2 1\"/>", "<cylinder radius=\"0.2\" length=\"1\"/>",
                            "<sphere radius=\"0.4\"/>"}) {
        SCOPED_TRACE(tip);
        std::ofstream(spec.file) << arm(tip);
        const Scene scene = make_scene(spec);
        const AnswerList<StateDistance> answers = answers_of(scene);
        const Judgement judged = distances.make_truth(scene, 2)->judge(answers, ours);
        EXPECT_EQ(judged.status, Status::within_bound) << judged.check.witness;
        EXPECT_EQ(judged.check.n_checked, 200u);
        const auto touch = std::ranges::count(answers.list, 0.0, &StateDistance::distance);
        EXPECT_GT(touch, 10);
        EXPECT_LT(touch, 190);
    }
}

TEST_F(RobotDistance, TheTruthSeesWhatIsWrong) {
    const Scene scene = make_scene(spec);
    const AnswerList<StateDistance> right = answers_of(scene);
    const auto truth = distances.make_truth(scene, 2);
    const auto apart = static_cast<std::size_t>(
        std::ranges::find_if(right.list, [](const StateDistance& d) { return d.distance > .05; }) -
        right.list.begin());
    ASSERT_LT(apart, right.list.size());
    const auto judged = [&](auto&& spoil) {
        AnswerList<StateDistance> wrong;
        wrong.list = right.list;
        spoil(wrong.list[apart]);
        const results::Check check = truth->judge(wrong, ours).check;
        EXPECT_EQ(check.missing + check.extra, 1u) << check.witness;
        EXPECT_NE(check.witness.find("state " + std::to_string(apart) + ":"), std::string::npos);
        return check;
    };
    const auto by = [](double factor) {
        return [factor](StateDistance& d) { d.distance *= factor, d.lo *= factor, d.hi *= factor; };
    };
    EXPECT_EQ(judged(by(1.001)).missing, 1u);
    EXPECT_EQ(judged(by(.999)).extra, 1u);
    EXPECT_EQ(judged([](StateDistance& d) { d.lo *= .99; }).bound_violations, 1u);
    EXPECT_EQ(judged([](StateDistance& d) { d.hi *= 1.01; }).bound_violations, 1u);
    EXPECT_EQ(judged([](StateDistance& d) { d.links = {0, 1}; }).missing, 1u); // may touch
    EXPECT_EQ(judged([](StateDistance& d) { d.distance = std::nan(""); }).missing, 1u);
    EXPECT_EQ(judged([](StateDistance& d) { // another pair, which is farther
                  d.links = d.links.b == 3 ? Pair{0, 2} : Pair{0, 3};
              })
                  .extra,
              1u);
    AnswerList<StateDistance> few;
    EXPECT_EQ(truth->judge(few, ours).check.missing, right.list.size());
}

/// A robot that others made, which is no part of the project: read where it is.
TEST_F(RobotSelf, IsRightOfPanda) {
    const fs::path panda = "../shared/data/robots/panda/panda.urdf";
    if (!fs::exists(panda))
        GTEST_SKIP() << panda << " is not here: the sample robots are no part of the project";
    const Scene scene = make_scene({.generator = "robot", .file = panda, .n_poses = 60});
    EXPECT_GT(agreed(scene), 0u);
    const Task& distances = *find_task("robot_distance");
    const ContenderEntry ours = distances.contender({});
    const auto contender = ours.make({&scene, &distances});
    AnswerList<StateDistance> answers;
    contender->build();
    contender->query(answers);
    const Judgement judged = distances.make_truth(scene, 2)->judge(answers, ours);
    EXPECT_EQ(judged.status, Status::within_bound) << judged.check.witness;
}

} // namespace
} // namespace boxwood::bench
