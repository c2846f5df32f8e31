#include "bench/tasks/detail/mesh_pair_task.h"

#include "bench/truth/truth.h"
#include "kernels/oracle/nearest.h"
#include "scenes/sampling/poses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace boxwood::bench {
namespace {

Scene posed(std::string_view kind, std::size_t n = 700) {
    return make_scene(
        {.generator = "sphere_mesh", .n = n, .poses = std::string(kind), .n_poses = 4});
}

/// Ours of every volume, and each peer's.
std::vector<ContenderEntry> contenders_of(const Task& task) {
    std::vector<ContenderEntry> all = peers_that_answer(task.name());
    for (const char* builder : {"binned_sah", "lbvh", "median"})
        for (const char* volume : {"obb", "aabb"}) {
            Choice choice;
            choice.builder = builder;
            choice.layout = volume;
            all.push_back(task.contender(choice));
        }
    return all;
}

TEST(MeshPairTasks, AreAnsweredAsTheTruthSays) {
    for (const char* name : {"collide", "collide_all", "distance"})
        for (const PoseKindEntry& kind : pose_kinds()) {
            const Task& task = *find_task(name);
            const Scene scene = posed(kind.name);
            const auto truth = task.make_truth(scene, 2);
            for (const ContenderEntry& entry : contenders_of(task)) {
                SCOPED_TRACE(std::string(name) + " " + std::string(kind.name) + " " + entry.name);
                const auto contender = entry.make({&scene, &task});
                const auto answers = task.make_answers();
                for (int again = 0; again < 2; ++again) {
                    contender->build();
                    contender->query(*answers);
                }
                const Judgement judged = truth->judge(*answers, entry);
                // FCL's distances are wrong where two touch (hard-cases.md).
                if (entry.is_peer && std::string_view(name) == "distance" &&
                    (kind.name == "deep" || kind.name == "shallow"))
                    continue;
                EXPECT_NE(judged.status, Status::wrong) << judged.check.witness;
                if (entry.is_peer)
                    continue;
                const auto counted = task.make_answers();
                const auto work = contender->counted_query(*counted);
                ASSERT_TRUE(work);
                EXPECT_GT(work->node_visits, 0u);
                EXPECT_EQ(task.hash(*counted), task.hash(*answers));
                EXPECT_GT(contender->structure()->bytes, 0u);
            }
        }
}

TEST(MeshPairTasks, TheTruthSeesWhatIsWrong) {
    const Scene scene = posed("deep");
    const ContenderEntry nobody;
    {
        const Task& task = *find_task("collide");
        AnswerList<std::uint8_t> answers;
        answers.list.assign(scene.poses.size(), 0);
        const Judgement judged = task.make_truth(scene, 1)->judge(answers, nobody);
        EXPECT_EQ(judged.status, Status::wrong);
        EXPECT_EQ(judged.check.missing, scene.poses.size());
    }
    {
        const Task& task = *find_task("collide_all");
        const auto answers = task.make_answers();
        const ContenderEntry ours = contenders_of(task).back();
        const auto contender = ours.make({&scene, &task});
        contender->build();
        contender->query(*answers);
        auto& list = list_of<PosedPair>(*answers);
        list.pop_back();
        list.push_back({0, 0, 0});
        const Judgement judged = task.make_truth(scene, 1)->judge(*answers, ours);
        EXPECT_EQ(judged.check.missing, 1u);
        EXPECT_EQ(judged.check.extra, 1u);
    }
    {
        const Task& task = *find_task("distance");
        const Scene apart = posed("apart");
        const auto answers = task.make_answers();
        const ContenderEntry ours = contenders_of(task).back();
        const auto contender = ours.make({&apart, &task});
        contender->build();
        for (const double factor : {.999, 1.001}) {
            contender->query(*answers);
            PosedDistance& first = list_of<PosedDistance>(*answers).front();
            first.distance *= factor;
            first.lo *= factor;
            first.hi *= factor;
            const Judgement judged = task.make_truth(apart, 1)->judge(*answers, ours);
            EXPECT_EQ(judged.status, Status::wrong) << factor;
        }
    }
}

/// Another pair of triangles with its own true distance, just farther: for any number of triangles.
TEST(MeshPairTasks, TheTruthSeesThatAnotherPairIsNearer) {
    const Task& task = *find_task("distance");
    for (const char* kind : {"apart", "near"}) {
        const Scene scene = posed(kind, 6000);
        const auto answers = task.make_answers();
        const ContenderEntry ours = contenders_of(task).back();
        const auto contender = ours.make({&scene, &task});
        contender->build();
        contender->query(*answers);
        const auto truth = task.make_truth(scene, 2);
        ASSERT_NE(truth->judge(*answers, ours).status, Status::wrong);
        for (std::size_t i = 0; i < scene.poses.size(); ++i) {
            auto wrong = task.make_answers();
            list_of<PosedDistance>(*wrong) = list_of<PosedDistance>(*answers);
            PosedDistance& got = list_of<PosedDistance>(*wrong)[i];
            const Triangle<float> a = scene.mesh.triangle(got.triangles.a);
            const auto corner = [&](std::uint32_t b, int k) {
                const Triangle<float> t = scene.mesh.triangle(b);
                return scene.poses[i](Vec3<double>(k == 0 ? t.a : k == 1 ? t.b : t.c));
            };
            const auto distance_to = [&](std::uint32_t b) {
                return std::sqrt(oracle::nearest({Vec3<double>(a.a), Vec3<double>(a.b), Vec3<double>(a.c)},
                                                 {corner(b, 0), corner(b, 1), corner(b, 2)})
                                     .squared.get_d());
            };
            // The next one in the mesh that does not share the nearest point.
            std::uint32_t other = got.triangles.b;
            double farther = got.distance;
            while (!(farther > got.distance * (1 + 1e-6))) {
                other = (other + 1) % static_cast<std::uint32_t>(scene.mesh.triangles.size());
                farther = distance_to(other);
            }
            got.triangles.b = other;
            got.distance = got.lo = got.hi = farther;
            const Judgement judged = truth->judge(*wrong, ours);
            EXPECT_EQ(judged.status, Status::wrong) << kind << " " << i;
            EXPECT_EQ(judged.check.missing, 1u);
        }
    }
}

TEST(MeshPairTasks, WantPosesAndKnownVolumes) {
    const Task& task = *find_task("collide");
    const Scene scene = make_scene({.generator = "sphere_mesh", .n = 100});
    EXPECT_TRUE(task.missing(scene));
    Choice choice;
    choice.layout = "obbb";
    EXPECT_THROW(task.contender(choice), std::invalid_argument);
}

} // namespace
} // namespace boxwood::bench
