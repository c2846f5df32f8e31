#include "bench/tasks/detail/point_task.h"

#include "bench/io/bad_input.h"
#include "bench/plan/plan.h"
#include "trees/queries/sinks.h"

#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

struct Question {
    Scene scene;
    const Task& task;
};

std::vector<Question> questions() {
    std::vector<Question> all;
    for (const auto& [generator, regions, task, k] :
         {std::tuple{"uniform", "", "points", 1}, std::tuple{"uniform", "boxes", "regions", 1},
          std::tuple{"clusters", "spheres", "regions", 1}, std::tuple{"uniform", "", "nearest", 1},
          std::tuple{"clusters", "", "nearest", 7},
          std::tuple{"sphere_mesh", "", "closest_points", 1},
          std::tuple{"triangle_soup", "", "closest_points", 1}}) {
        SceneSpec spec{.generator = generator, .n = 1500};
        spec.n_points = 400;
        spec.regions = regions;
        if (task == std::string("nearest"))
            spec.k = k;
        all.push_back({make_scene(spec), *find_task(task)});
    }
    return all;
}

TEST(PointQueries, OursAndThePeersAreRight) {
    std::size_t answered = 0;
    for (const auto& [scene, task] : questions()) {
        SCOPED_TRACE(scene.name + " " + std::string(task.name()));
        const std::unique_ptr<Truth> truth = task.make_truth(scene, 2);
        std::vector<ContenderEntry> entries = peers_that_answer(task.name());
        EXPECT_GE(entries.size(), peers().size() < 2 ? 0u : 1u);
        for (const LayoutEntry& layout : layouts())
            for (const char* calls : {"given", "single"}) {
                Choice choice{"median", {}, std::string(layout.name), "", ""};
                choice.ray_order = calls;
                entries.push_back(task.contender(choice));
            }
        for (const ContenderEntry& entry : entries)
            for (const auto& [executor, threads] :
                 {std::pair{"serial", 1u}, std::pair{"tbb", 2u}}) {
                SCOPED_TRACE(entry.name + " " + executor);
                const Job job{&scene, &task, executor, threads};
                if (entry.unsupported(job))
                    continue;
                const auto contender = entry.make(job);
                contender->build();
                const auto answers = task.make_answers();
                contender->query(*answers);
                const Judgement judged = truth->judge(*answers, entry);
                const results::Check& check = judged.check;
                EXPECT_EQ(check.missing, 0u) << check.witness;
                EXPECT_EQ(check.extra, 0u) << check.witness;
                // Triangles that share an edge are equally near, up to rounding.
                if (entry.is_peer || task.name() == "closest_points") {
                    EXPECT_NE(judged.status, Status::wrong) << check.witness;
                } else {
                    EXPECT_EQ(judged.status, Status::exact) << check.witness;
                }
                EXPECT_EQ(check.n_checked, 400u);
                EXPECT_EQ(task.n_queries(scene), 400u);
                const std::uint64_t hash = task.hash(*answers);
                contender->query(*answers);
                EXPECT_EQ(task.hash(*answers), hash);
                ++answered;
            }
    }
    EXPECT_GE(answered, questions().size() * layouts().size() * 4);
}

/// The right answers are right, and each way to spoil them is seen.
template <class T, class... Spoil> void expect_wrong(const Question& question, Spoil... spoil) {
    const auto& [scene, task] = question;
    SCOPED_TRACE(scene.name + " " + std::string(task.name()));
    const std::unique_ptr<Truth> truth = task.make_truth(scene, 1);
    const ContenderEntry entry = task.contender({"median", {}, "wide8", "", ""});
    const auto contender = entry.make(Job{&scene, &task, "serial", 1});
    contender->build();
    AnswerList<T> right;
    contender->query(right);
    EXPECT_NE(truth->judge(right, entry).status, Status::wrong);
    const auto check = [&](const auto& change) {
        AnswerList<T> answers = right;
        change(answers.list);
        EXPECT_EQ(truth->judge(answers, entry).status, Status::wrong);
        EXPECT_FALSE(truth->judge(answers, entry).check.witness.empty());
        EXPECT_NE(task.hash(answers), task.hash(right));
    };
    (check(spoil), ...);
}

TEST(PointQueries, TheTruthSeesWhatIsWrong) {
    for (const Question& question : questions())
        if (question.task.name() == "nearest")
            expect_wrong<Neighbour>(
                question, [](auto& x) { x.pop_back(); }, [](auto& x) { x[3].item ^= 1; },
                [](auto& x) { x[3].squared_distance += 1; }, [](auto& x) { x[3] = {}; });
        else if (question.task.name() == "closest_points")
            expect_wrong<SurfacePoint>(
                question, [](auto& x) { x.pop_back(); }, [](auto& x) { x[5].point.x += .1f; },
                [](auto& x) { x[5].triangle ^= 1024; },
                [](auto& x) { x[5].squared_distance += 1; });
        else
            expect_wrong<Pair>(
                question, [](auto& x) { x.pop_back(); }, [](auto& x) { x.push_back(x.front()); },
                [](auto& x) {
                    x.push_back({100'000, 0});
                });
}

TEST(PointQueries, AreOfTheClassOfTheirCalls) {
    using Classes = std::vector<std::string>;
    for (const char* task : {"points", "regions", "nearest", "closest_points"}) {
        Choice choice{"median", {}, "wide8", "", ""};
        EXPECT_EQ(find_task(task)->contender(choice).classes, Classes{"batches"});
        EXPECT_EQ(find_task(task)->contender(choice).name, std::string("median.wide8.") + task);
        choice.ray_order = "single";
        EXPECT_EQ(find_task(task)->contender(choice).classes, Classes{"one query a call"});
        EXPECT_EQ(find_task(task)->contender(choice).name,
                  std::string("median.wide8.single_") + task);
        for (const ContenderEntry& peer : peers_that_answer(task))
            EXPECT_EQ(peer.classes, peer.name.ends_with(".sorted") || peer.library == "warp"
                                        ? Classes{"batches"}
                                        : (Classes{"one query a call", "batches"}))
                << peer.name;
    }
}

TEST(PointQueries, SayWhatASceneLacks) {
    Scene scene;
    scene.boxes.assign(2, {{0, 0, 0}, {1, 1, 1}});
    for (const char* task : {"points", "regions", "nearest", "closest_points"})
        EXPECT_TRUE(find_task(task)->missing(scene)) << task;
    scene.points.push_back({0, 0, 0});
    EXPECT_FALSE(find_task("points")->missing(scene));
    EXPECT_EQ(find_task("closest_points")->missing(scene), "the scene has no triangles");
}

TEST(PointQueries, AreSweptByKindAndNumber) {
    const Plan plan = make_plan("[[cells]]\nscene = \"uniform\"\nbuilders = \"median\"\n"
                                "task = [\"points\", \"regions\", \"nearest\"]\n"
                                "n_points = 77\nregions = [\"boxes\", \"spheres\"]\nk = [1, 8]\n",
                                "x.toml", {});
    std::vector<std::string> names;
    for (const PlannedCell& cell : plan.cells) {
        names.push_back(cell.name.substr(0, cell.name.find(".")));
        EXPECT_EQ(cell.scene.n_points, 77u);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"uniform_points/n1000-s1/points/median",
                                               "uniform_boxes/n1000-s1/regions/median",
                                               "uniform_spheres/n1000-s1/regions/median",
                                               "uniform_points/n1000-s1/nearest/median",
                                               "uniform_points_k8/n1000-s1/nearest/median"}));
    const std::string pairs = "[[cells]]\nscene = \"uniform\"\ntask = \"pairs\"\n";
    for (const char* key : {"n_points = 5\n", "regions = \"boxes\"\n", "k = 2\n"})
        EXPECT_THROW(make_plan(pairs + "builders = \"median\"\n" + key, "x.toml", {}), BadInput);
    EXPECT_THROW(make_plan("[[cells]]\nscene = \"uniform\"\ntask = \"closest_points\"\n"
                           "builders = \"median\"\n",
                           "x.toml", {}),
                 BadInput);
}

} // namespace
} // namespace boxwood::bench
