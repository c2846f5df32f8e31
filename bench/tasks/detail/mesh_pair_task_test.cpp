#include "bench/tasks/detail/mesh_pair_task.h"

#include "bench/truth/truth.h"
#include "kernels/oracle/nearest.h"
#include "scenes/sampling/poses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace boxwood::bench {
namespace {

Scene posed(std::string_view kind, std::size_t n = 700, const char* motion = "") {
    return make_scene({.generator = "sphere_mesh",
                       .n = n,
                       .poses = std::string(kind),
                       .n_poses = 4,
                       .motion = motion});
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
            if (task.name() != "distance")
                continue;
            choice.relative_error = .1;
            all.push_back(task.contender(choice));
            choice.relative_error = 0;
            choice.warm_start = true;
            all.push_back(task.contender(choice));
        }
    return all;
}

/// Answers of ours that are right.
std::unique_ptr<Answers> right_answers(const Task& task, const Scene& scene) {
    Choice choice;
    choice.layout = "obb";
    const auto contender = task.contender(choice).make({&scene, &task});
    auto answers = task.make_answers();
    contender->build();
    contender->query(*answers);
    return answers;
}

/// FCL's distances and Coal's, of triangles that touch too, are wrong where two meshes touch
/// (hard-cases.md). FCL's continuousCollide passes through meshes, by each of its ways.
bool is_known_to_err(const ContenderEntry& entry, std::string_view task, std::string_view kind) {
    if (!entry.is_peer)
        return false;
    return task == "distance" ? kind == "deep" || kind == "shallow"
                              : task == "continuous" && !entry.name.ends_with(".stepped");
}

void expect_right_answers(const Task& task, const Scene& scene, std::string_view kind) {
    const auto truth = task.make_truth(scene, 2);
    for (const ContenderEntry& entry : contenders_of(task)) {
        SCOPED_TRACE(std::string(task.name()) + " " + scene.name + " " + entry.name);
        const auto contender = entry.make({&scene, &task});
        const auto answers = task.make_answers();
        for (int again = 0; again < 2; ++again) {
            contender->build();
            contender->query(*answers);
        }
        const Judgement judged = truth->judge(*answers, entry);
        if (is_known_to_err(entry, task.name(), kind))
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

TEST(MeshPairTasks, AreAnsweredAsTheTruthSays) {
    for (const char* name : {"collide", "collide_all", "distance", "tolerance", "contacts"})
        for (const PoseKindEntry& kind : pose_kinds())
            expect_right_answers(*find_task(name), posed(kind.name), kind.name);
}

TEST(MeshPairTasks, AWarmStartSavesWorkAlongAWay) {
    const Task& task = *find_task("distance");
    const Scene scene =
        make_scene({.generator = "sphere_mesh", .n = 2000, .poses = "along", .n_poses = 40});
    std::uint64_t tests[2];
    for (const bool is_warm : {false, true}) {
        Choice choice;
        choice.layout = "obb";
        choice.warm_start = is_warm;
        const ContenderEntry entry = task.contender(choice);
        EXPECT_EQ(entry.name.ends_with(".distance.warm"), is_warm);
        const auto contender = entry.make({&scene, &task});
        contender->build();
        const auto answers = task.make_answers();
        tests[is_warm] = contender->counted_query(*answers)->triangle_tests;
    }
    EXPECT_LT(tests[true], tests[false]);
}

TEST(MeshPairTasks, AnErrorThatIsAllowedSavesWorkAndIsJudged) {
    const Task& task = *find_task("distance");
    for (const char* kind : {"apart", "near"}) {
        const Scene scene = posed(kind, 6000);
        const auto truth = task.make_truth(scene, 2);
        std::uint64_t visits[2], wrong[2];
        for (const bool may_err : {true, false}) {
            Choice choice;
            choice.layout = "obb";
            choice.relative_error = may_err ? .2 : 0;
            const ContenderEntry entry = task.contender(choice);
            EXPECT_EQ(entry.name.ends_with(".distance.within_0.2"), may_err);
            EXPECT_EQ(entry.classes.empty(), !may_err);
            const auto contender = entry.make({&scene, &task});
            contender->build();
            const auto answers = task.make_answers();
            visits[may_err] = contender->counted_query(*answers)->node_visits;
            EXPECT_NE(truth->judge(*answers, entry).status, Status::wrong);
            // As wide as a fifth, less a little: too wide for one that may not err.
            for (PosedDistance& d : list_of<PosedDistance>(*answers))
                d.lo = std::min(d.lo, d.hi * .81);
            wrong[may_err] = truth->judge(*answers, entry).check.bound_violations;
            for (PosedDistance& d : list_of<PosedDistance>(*answers))
                d.lo = d.hi * .79;
            EXPECT_EQ(truth->judge(*answers, entry).check.bound_violations, scene.poses.size());
        }
        Choice choice;
        choice.layout = "obb";
        choice.relative_error = .2;
        const ContenderEntry entry = task.contender(choice);
        const auto answers = right_answers(task, scene);
        for (PosedDistance& d : list_of<PosedDistance>(*answers)) {
            d.distance *= 1.05; // farther than its triangles are
            d.hi = d.distance;
        }
        EXPECT_EQ(truth->judge(*answers, entry).check.extra, scene.poses.size());
        EXPECT_LT(visits[true], visits[false]) << kind;
        EXPECT_EQ(wrong[true], 0u) << kind;
        EXPECT_EQ(wrong[false], scene.poses.size()) << kind;
    }
}

TEST(MeshPairTasks, AnErrorIsNamedBesideTheSettingsOfTheBuilder) {
    Choice choice;
    choice.layout = "obb";
    choice.settings["bins"] = std::int64_t{4};
    choice.relative_error = 1e-5;
    choice.warm_start = true;
    const ContenderEntry entry = find_task("distance")->contender(choice);
    EXPECT_TRUE(entry.name.ends_with(".distance.warm.within_0.00001")) << entry.name;
    EXPECT_EQ(entry.params_json, R"({"bins": 4, "relative_error": 1e-05})");
    EXPECT_EQ(entry.classes, std::vector<std::string>{"warm start with relative error 0.00001"});
    EXPECT_EQ(entry.relative_width, 1e-5 + 0x1p-32);
}

TEST(MeshPairTasks, TouchesAreTheSameByTwoThreads) {
    const Task& task = *find_task("collide_all");
    const Scene scene = posed("deep", 3000);
    Choice choice;
    choice.layout = "obb";
    const auto answers = task.make_answers();
    std::uint64_t hashes[2];
    for (const unsigned threads : {1u, 2u}) {
        const auto contender = task.contender(choice).make(
            {&scene, &task, std::string(default_executor(threads)), threads});
        contender->build();
        contender->query(*answers);
        EXPECT_GT(answers->size(), 100u);
        hashes[threads - 1] = task.hash(*answers);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
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
        contender->query(*answers);
        for (PosedDistance& d : list_of<PosedDistance>(*answers))
            d.distance = d.lo = d.hi = std::nan("");
        const Judgement judged = task.make_truth(apart, 1)->judge(*answers, ours);
        EXPECT_EQ(judged.check.missing, apart.poses.size());
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
                return std::sqrt(
                    oracle::nearest({Vec3<double>(a.a), Vec3<double>(a.b), Vec3<double>(a.c)},
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

TEST(MeshPairTasks, TheTruthSeesTheWrongSideOfATolerance) {
    const Task& task = *find_task("tolerance");
    for (const char* kind : {"apart", "near"}) {
        const Scene scene = posed(kind);
        const auto truth = task.make_truth(scene, 2);
        const auto right = right_answers(task, scene);
        std::uint64_t yes = 0;
        for (std::size_t i = 0; i < scene.poses.size(); ++i) {
            auto wrong = task.make_answers();
            wrong->assign_bytes(right->bytes());
            std::uint8_t& one = list_of<std::uint8_t>(*wrong)[i];
            yes += one;
            one = one ? 0 : 1;
            const Judgement judged = truth->judge(*wrong, {});
            EXPECT_EQ(judged.check.missing, one ? 0u : 1u) << kind << " " << i;
            EXPECT_EQ(judged.check.extra, one ? 1u : 0u) << kind << " " << i;
            EXPECT_NE(judged.check.witness.find("pose " + std::to_string(i)), std::string::npos);
        }
        EXPECT_EQ(yes, 2u) << kind; // a half
    }
}

TEST(MeshPairTasks, TheTruthSeesWhatIsWrongOfContacts) {
    const Task& task = *find_task("contacts");
    const Scene scene = posed("deep");
    const auto truth = task.make_truth(scene, 2);
    const auto right = right_answers(task, scene);
    const std::size_t n = right->size();
    ASSERT_GT(n, 20u);
    const auto judged = [&](auto&& spoil) {
        auto wrong = task.make_answers();
        wrong->assign_bytes(right->bytes());
        spoil(list_of<PosedContact>(*wrong));
        return truth->judge(*wrong, {}).check;
    };
    using List = std::vector<PosedContact>;
    EXPECT_EQ(judged([](List&) {}).extra, 0u);
    const results::Check lacks = judged([](List& list) { list.erase(list.begin() + 3); });
    EXPECT_EQ(lacks.missing, 1u);
    EXPECT_NE(lacks.witness.find("a contact is missing"), std::string::npos);
    EXPECT_EQ(judged([](List& list) { list.push_back(list.back()); }).extra, 0u); // twice is right
    EXPECT_EQ(judged([](List& list) {
                  list.push_back(list.back());
                  list.back().triangles.a = list.back().triangles.b = 0;
              }).extra,
              1u);
    EXPECT_EQ(judged([](List& list) { std::swap(list[0], list[1]); }).extra, 1u);
    EXPECT_EQ(judged([](List& list) { list[0].normal = 1.1 * list[0].normal; }).extra, 1u);
    EXPECT_EQ(judged([](List& list) { list[0].point.x += 10; }).extra, 1u);
    EXPECT_EQ(judged([](List& list) { list[0].depth *= 1.01; }).extra, 1u);
    EXPECT_EQ(judged([](List& list) { list[0].normal.x = std::nan(""); }).extra, 1u);
    EXPECT_EQ(judged([](List& list) { list.clear(); }).missing, n);
    // Moved by a half of the way many still touch; others are beside each other.
    EXPECT_GT(judged([](List& list) {
                  for (PosedContact& c : list)
                      c.depth /= 2;
              }).extra,
              n / 4);
}

TEST(MeshPairTasks, AreAnsweredInMotionAsTheTruthSays) {
    for (const char* motion : {"linear", "screw"})
        for (const char* kind : {"apart", "near"})
            expect_right_answers(*find_task("continuous"), posed(kind, 300, motion), kind);
}

TEST(MeshPairTasks, TheTruthSeesAMeetingTooLate) {
    const Task& task = *find_task("continuous");
    std::size_t met = 0, passed = 0;
    for (const char* motion : {"linear", "screw"}) {
        const Scene scene = posed("apart", 700, motion);
        const auto truth = task.make_truth(scene, 2);
        const auto right = right_answers(task, scene);
        for (std::size_t i = 0; i < scene.poses.size(); ++i) {
            const auto judged = [&](FirstMeeting one) {
                auto wrong = task.make_answers();
                wrong->assign_bytes(right->bytes());
                list_of<FirstMeeting>(*wrong)[i] = one;
                const results::Check check = truth->judge(*wrong, {}).check;
                EXPECT_EQ(check.missing + check.extra, 1u) << motion << " " << i;
                return check.missing == 1;
            };
            const FirstMeeting one = list_of<FirstMeeting>(*right)[i];
            EXPECT_FALSE(judged({.5, .4, Meets::yes}));
            EXPECT_FALSE(judged({.5, 1, Meets::no}));
            if (one.meets == Meets::yes) {
                ++met;
                EXPECT_TRUE(judged({1, 1, Meets::no}));
                EXPECT_TRUE(judged({one.t_free + .01, one.t_hit + .01, Meets::yes}));
                EXPECT_FALSE(judged({one.t_free / 2, one.t_hit / 2, Meets::yes}));
            } else {
                ++passed;
                EXPECT_FALSE(judged({.5, .5, Meets::yes}));
            }
        }
    }
    EXPECT_GT(met, 0u);
    EXPECT_GT(passed, 0u);
}

TEST(MeshPairTasks, WantPosesAndKnownVolumes) {
    const Task& task = *find_task("collide");
    const Scene scene = make_scene({.generator = "sphere_mesh", .n = 100});
    EXPECT_TRUE(task.missing(scene));
    EXPECT_TRUE(find_task("continuous")->missing(scene));
    EXPECT_FALSE(find_task("continuous")->missing(posed("near", 100, "screw")));
    Choice choice;
    choice.layout = "obbb";
    EXPECT_THROW(task.contender(choice), std::invalid_argument);
}

} // namespace
} // namespace boxwood::bench
