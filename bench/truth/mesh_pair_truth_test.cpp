#include "bench/truth/mesh_pair_truth.h"

#include "bench/tasks/detail/mesh_pair_answers.h"
#include "bench/testing/posed_meshes.h"
#include "kernels/oracle/nearest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace boxwood::bench {
namespace {

ContenderEntry ours_of(const Task& task) {
    Choice choice;
    choice.layout = "obb";
    return task.contender(choice);
}

TEST(MeshPairTruth, SeesWhatIsWrong) {
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
        const ContenderEntry ours = ours_of(task);
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
        const ContenderEntry ours = ours_of(task);
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
TEST(MeshPairTruth, SeesThatAnotherPairIsNearer) {
    const Task& task = *find_task("distance");
    for (const char* kind : {"apart", "near"}) {
        const Scene scene = posed(kind, 6000);
        const auto answers = task.make_answers();
        const ContenderEntry ours = ours_of(task);
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

/// Points that are off their triangles, or on them elsewhere, by what no rounding explains.
TEST(MeshPairTruth, SeesWrongClosestPoints) {
    const Task& task = *find_task("distance");
    ContenderEntry peer; // promises nothing
    peer.precision = "f64";
    for (const char* kind : {"apart", "near", "deep"}) {
        SCOPED_TRACE(kind);
        const Scene scene = posed(kind);
        const auto truth = task.make_truth(scene, 2);
        const ContenderEntry ours = ours_of(task);
        const auto right = right_answers(task, scene);
        const auto judged = [&](const ContenderEntry& by, auto&& spoil) {
            auto wrong = task.make_answers();
            wrong->assign_bytes(right->bytes());
            spoil(list_of<PosedDistance>(*wrong)[1]);
            return truth->judge(*wrong, by);
        };
        EXPECT_NE(judged(ours, [](PosedDistance&) {}).status, Status::wrong);
        EXPECT_NE(judged(peer, [](PosedDistance&) {}).status, Status::wrong);
        const auto violations = [&](auto&& spoil) {
            return judged(ours, spoil).check.bound_violations;
        };
        if (kind != std::string_view("deep")) {
            EXPECT_EQ(violations([](PosedDistance& d) { d.lo *= .99; }), 1u);
            EXPECT_EQ(violations([](PosedDistance& d) { d.hi *= 1e300; }), 1u);
        }
        const auto off = [](Vec3<double> p) { return Vec3<double>{p.x, p.y + 1e-6, p.z - 1e-6}; };
        for (const ContenderEntry& by : {ours, peer}) {
            const auto fault = [&](auto&& spoil) {
                const Judgement judgement = judged(by, spoil);
                EXPECT_EQ(judgement.check.extra, 1u);
                EXPECT_EQ(judgement.check.missing, 0u);
                return judgement.check.witness;
            };
            using testing::HasSubstr;
            EXPECT_THAT(
                fault([&](PosedDistance& d) { d.points->on_mesh = off(d.points->on_mesh); }),
                HasSubstr("pose 1: the first point"));
            EXPECT_THAT(
                fault([&](PosedDistance& d) { d.points->on_copy = off(d.points->on_copy); }),
                HasSubstr("pose 1: the second point"));
            EXPECT_THAT(fault([](PosedDistance& d) { d.points->on_copy.x = std::nan(""); }),
                        HasSubstr("not finite"));
            EXPECT_THAT(fault([&](PosedDistance& d) { // on its triangle, at the farthest corner
                            const Triangle<float> a = scene.mesh.triangle(d.triangles.a);
                            Vec3<double> corner(a.a);
                            for (const Vec3<float> c : {a.b, a.c})
                                if (length(Vec3<double>(c) - d.points->on_copy) >
                                    length(corner - d.points->on_copy))
                                    corner = Vec3<double>(c);
                            d.points->on_mesh = corner;
                        }),
                        HasSubstr("its points are"));
        }
        const auto without = [](PosedDistance& d) { d.points.reset(); };
        EXPECT_EQ(judged(ours, without).check.extra, 1u); // must have them
        EXPECT_NE(judged(peer, without).status, Status::wrong);
    }
}

TEST(MeshPairTruth, SeesTheWrongSideOfATolerance) {
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

TEST(MeshPairTruth, SeesWhatIsWrongOfContacts) {
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

TEST(MeshPairTruth, SeesAMeetingTooLate) {
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

} // namespace
} // namespace boxwood::bench
