#include "bench/tasks/points.h"

#include "bench/io/bad_input.h"
#include "bench/tasks/ours.h"
#include "bench/plan/plan.h"
#include "bench/truth/point_truth.h"

#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

struct Asked {
    Scene scene;
    Ask ask;
};

std::vector<Asked> asked() {
    std::vector<Asked> all;
    for (const auto& [generator, regions, ask, k] :
         {std::tuple{"uniform", "", Ask::points, 1},
          std::tuple{"uniform", "boxes", Ask::regions, 1},
          std::tuple{"clusters", "spheres", Ask::regions, 1},
          std::tuple{"uniform", "", Ask::nearest, 1}, std::tuple{"clusters", "", Ask::nearest, 7},
          std::tuple{"sphere_mesh", "", Ask::closest_points, 1},
          std::tuple{"triangle_soup", "", Ask::closest_points, 1}}) {
        SceneSpec spec{.generator = generator, .n = 1500};
        spec.n_points = 400;
        spec.regions = regions;
        if (ask == Ask::nearest)
            spec.k = k;
        all.push_back({make_scene(spec), ask});
    }
    return all;
}

TEST(PointQueries, OursAndThePeersAreRight) {
    std::size_t answered = 0;
    for (const Asked& a : asked()) {
        SCOPED_TRACE(a.scene.name + " " + std::string(to_string(a.task)));
        const std::unique_ptr<Truth> truth = make_point_truth(a.scene, a.task, 2);
        std::vector<ContenderEntry> entries = peers_that_answer(a.task);
        EXPECT_GE(entries.size(), a.task == Ask::regions || peers().size() < 2 ? 0u : 1u);
        for (const LayoutEntry& layout : layouts())
            entries.push_back(our_contender({"median", {}, std::string(layout.name), ""}, a.task));
        for (const ContenderEntry& entry : entries)
            for (const auto& [executor, threads] :
                 {std::pair{"serial", 1u}, std::pair{"tbb", 2u}}) {
                SCOPED_TRACE(entry.name + " " + executor);
                const Job job{&a.scene, a.task, executor, threads};
                if (entry.unsupported(job))
                    continue;
                const auto contender = entry.make(job);
                contender->build();
                Answers answers;
                contender->query(answers);
                const results::Check check = truth->check(answers);
                EXPECT_EQ(check.missing, 0u) << check.witness;
                EXPECT_EQ(check.extra, 0u) << check.witness;
                // Triangles that share an edge are equally near, up to rounding.
                if (entry.is_peer || a.task == Ask::closest_points) {
                    EXPECT_NE(check.status, "wrong") << check.witness;
                } else {
                    EXPECT_EQ(check.status, "exact") << check.witness;
                }
                EXPECT_EQ(check.n_checked, 400u);
                const std::uint64_t hash = answer_hash(answers, a.task);
                contender->query(answers);
                EXPECT_EQ(answer_hash(answers, a.task), hash);
                ++answered;
            }
    }
    EXPECT_GE(answered, asked().size() * layouts().size() * 2);
}

TEST(PointQueries, TheTruthSeesWhatIsWrong) {
    for (const Asked& a : asked()) {
        SCOPED_TRACE(a.scene.name + " " + std::string(to_string(a.task)));
        const std::unique_ptr<Truth> truth = make_point_truth(a.scene, a.task, 1);
        const Job job{&a.scene, a.task, "serial", 1};
        const auto contender = our_contender({"median", {}, "wide8", ""}, a.task).make(job);
        contender->build();
        Answers right;
        contender->query(right);
        const auto expect_wrong = [&](const auto& spoil) {
            Answers answers = right;
            spoil(answers);
            EXPECT_EQ(truth->check(answers).status, "wrong");
            EXPECT_FALSE(truth->check(answers).witness.empty());
            EXPECT_NE(answer_hash(answers, a.task), answer_hash(right, a.task));
        };
        if (a.task == Ask::points || a.task == Ask::regions) {
            expect_wrong([](Answers& x) { x.pairs.pop_back(); });
            expect_wrong([](Answers& x) { x.pairs.push_back(x.pairs.front()); });
            expect_wrong([](Answers& x) { x.pairs.push_back({100'000, 0}); });
        } else if (a.task == Ask::nearest) {
            expect_wrong([](Answers& x) { x.neighbours.pop_back(); });
            expect_wrong([](Answers& x) { x.neighbours[3].item ^= 1; });
            expect_wrong([](Answers& x) { x.neighbours[3].squared_distance += 1; });
            expect_wrong([](Answers& x) { x.neighbours[3] = {}; });
        } else {
            expect_wrong([](Answers& x) { x.surface_points.pop_back(); });
            expect_wrong([](Answers& x) { x.surface_points[5].point.x += .1f; });
            expect_wrong([](Answers& x) { x.surface_points[5].triangle ^= 1024; });
            expect_wrong([](Answers& x) { x.surface_points[5].squared_distance += 1; });
        }
    }
}

TEST(PointQueries, SayWhatASceneLacks) {
    Scene scene;
    scene.boxes.assign(2, {{0, 0, 0}, {1, 1, 1}});
    for (const Ask ask : {Ask::points, Ask::regions, Ask::nearest, Ask::closest_points})
        EXPECT_TRUE(no_queries(&scene, ask)) << to_string(ask);
    scene.points.push_back({0, 0, 0});
    EXPECT_FALSE(no_queries(&scene, Ask::points));
    EXPECT_EQ(no_queries(&scene, Ask::closest_points), "the scene has no triangles");
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
