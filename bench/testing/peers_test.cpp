#include "bench/plan/families.h"
#include "bench/tasks/contender.h"
#include "bench/tasks/detail/halves.h"
#include "bench/tasks/task.h"
#include "scenes/moving/frames.h"
#include "trees/queries/sinks.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

/// FCL 0.7's array tree never frees the leaves of a bulk registration.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libfcl.so\n"; }

namespace boxwood::bench {
namespace {

using Box = Aabb<float>;

Scene scene_of(std::vector<Box> boxes) {
    Scene scene;
    scene.boxes = std::move(boxes);
    return scene;
}

std::vector<Box> random_boxes(std::size_t n, float size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<Box> boxes(n);
    for (Box& b : boxes) {
        b.min = {unit(random), unit(random), unit(random)};
        b.max = b.min + size * Vec3<float>{unit(random), unit(random), unit(random)};
    }
    return boxes;
}

/// Boxes with integer corners: faces, edges and corners touch, and many are flat or points.
std::vector<Box> lattice_boxes(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    const auto number = [&](unsigned max_value) {
        return static_cast<float>(random() % (max_value + 1));
    };
    std::vector<Box> boxes(n);
    for (Box& b : boxes) {
        b.min = {number(9), number(9), number(9)};
        b.max = b.min + Vec3<float>{number(2), number(2), number(2)};
    }
    return boxes;
}

struct NamedBoxes {
    const char* name;
    std::vector<Box> boxes;
};

std::vector<NamedBoxes> box_scenes() {
    const float tiny = std::numeric_limits<float>::denorm_min();
    const Box unit{{0, 0, 0}, {1, 1, 1}};
    std::vector<NamedBoxes> scenes{
        {"none", {}},
        {"one", {unit}},
        {"two_touching", {unit, {{1, 1, 1}, {2, 2, 2}}}},
        {"two_apart", {unit, {{std::nextafter(1.0f, 2.0f), 0, 0}, {2, 1, 1}}}},
        {"denormal_gap", {{{0, 0, 0}, {tiny, 1, 1}}, {{2 * tiny, 0, 0}, {3 * tiny, 1, 1}}}},
        {"random", random_boxes(1500, 0.15f, 1)},
        {"sparse", random_boxes(3001, 0.01f, 2)},
        {"touching", lattice_boxes(1200, 3)},
        {"identical", std::vector<Box>(300, unit)},
        {"one_point", std::vector<Box>(200, Box{{1, 2, 3}, {1, 2, 3}})},
        {"flat", {}},
        {"far", {}},
    };
    for (Box b : random_boxes(400, 0.1f, 6)) {
        b.min.z = b.max.z = 0.5f;
        scenes[scenes.size() - 2].boxes.push_back(b);
    }
    for (Box b : random_boxes(400, 0.3f, 4)) { // coordinates far from 0: a margin would show
        b.min = b.min + Vec3<float>{1e6f, -1e6f, 1e6f};
        b.max = b.max + Vec3<float>{1e6f, -1e6f, 1e6f};
        scenes.back().boxes.push_back(b);
    }
    return scenes;
}

std::vector<Pair> expected_pairs(const std::vector<Box>& boxes, bool of_two_halves) {
    std::vector<Pair> pairs;
    const std::size_t n = boxes.size(), split = tree_pairs_split(n);
    for (std::uint32_t i = 0; i < (of_two_halves ? split : n); ++i)
        for (auto j = static_cast<std::uint32_t>(of_two_halves ? split : i + 1); j < n; ++j) {
            bool apart = false;
            for (int axis = 0; axis < 3; ++axis)
                apart |= static_cast<double>(boxes[i].min[axis]) >
                             static_cast<double>(boxes[j].max[axis]) ||
                         static_cast<double>(boxes[j].min[axis]) >
                             static_cast<double>(boxes[i].max[axis]);
            if (!apart)
                pairs.push_back({i, j});
        }
    return pairs;
}

/// Whether boxes of the scene are flat, or touch without sharing more than a face.
bool has_touching(const std::vector<Box>& boxes) {
    const auto flat = [](const Box& a, const Box& b) {
        bool apart = false, touch = false;
        for (int axis = 0; axis < 3; ++axis) {
            const float low = std::max(a.min[axis], b.min[axis]),
                        high = std::min(a.max[axis], b.max[axis]);
            apart |= low > high;
            touch |= low == high;
        }
        return touch && !apart;
    };
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t j = i; j < boxes.size(); ++j)
            if (flat(boxes[i], boxes[j]))
                return true;
    return false;
}

/// Calls f(entry, job) for each contender and each way it can run.
template <class F> void for_each_way(const Scene& scene, const Task& task, F f) {
    for (const Peer& peer : peers())
        for (const ContenderEntry& entry : peer.contenders)
            for (const auto& [executor, threads] :
                 {std::pair{"serial", 1u}, std::pair{"tbb", 1u}, std::pair{"tbb", 2u}}) {
                const Job job{&scene, &task, executor, threads};
                if (!entry.unsupported(job))
                    f(entry, job);
            }
}

class PeersOnBoxes : public testing::TestWithParam<const char*> {};

TEST_P(PeersOnBoxes, AgreeWithTwoLoops) {
    for (const NamedBoxes& named : box_scenes()) {
        const Scene scene = scene_of(named.boxes);
        const Task& task = *find_task(GetParam());
        const std::vector<Pair> expected = expected_pairs(scene.boxes, task.name() == "tree_pairs");
        const bool touching = has_touching(scene.boxes);
        int ways = 0;
        for_each_way(scene, task, [&](const ContenderEntry& entry, const Job& job) {
            if (touching && entry.misses_touching)
                return;
            SCOPED_TRACE(entry.name + " on " + named.name + ", " + job.executor + " " +
                         std::to_string(job.threads));
            ++ways;
            const auto contender = entry.make(job);
            AnswerList<Pair> answers;
            answers.list.push_back({7, 8}); // what an earlier query left
            for (int again = 0; again < 2; ++again) {
                contender->build();
                for (int query = 0; query < 2; ++query) {
                    contender->query(answers);
                    std::ranges::sort(answers.list);
                    EXPECT_EQ(answers.list, expected);
                }
            }
        });
        EXPECT_GT(ways, 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Tasks, PeersOnBoxes, testing::Values("pairs", "tree_pairs"),
                         [](const auto& p) { return std::string(p.param); });

TEST(Peers, RegistryIsWellFormed) {
    std::vector<std::string> names;
    ASSERT_FALSE(peers().empty());
    EXPECT_EQ(peers()[0].name, "brute_force");
    for (const Peer& peer : peers()) {
        EXPECT_FALSE(peer.summary.empty());
        EXPECT_FALSE(peer.version.empty());
        EXPECT_FALSE(peer.build.empty());
        for (const std::string_view absent : absent_peers())
            EXPECT_NE(peer.name, absent);
        for (const ContenderEntry& entry : peer.contenders) {
            EXPECT_EQ(entry.library, peer.name);
            EXPECT_TRUE(entry.name.starts_with(peer.name)) << entry.name;
            EXPECT_EQ(entry.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_."),
                      std::string::npos);
            EXPECT_FALSE(entry.summary.empty() || entry.notes.empty());
            EXPECT_TRUE(entry.precision == "f32" || entry.precision == "f64");
            EXPECT_TRUE(entry.is_peer);
            names.push_back(entry.name);
        }
    }
    std::ranges::sort(names);
    EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

TEST(Peers, SayWhatTheyCannotDo) {
    const Scene scene = scene_of(random_boxes(2, 1, 1));
    for (const Peer& peer : peers())
        for (const ContenderEntry& entry : peer.contenders) {
            std::size_t tasks_answered = 0;
            for (const Task* task : tasks()) {
                EXPECT_TRUE(entry.unsupported({&scene, task, "openmp", 2})) << entry.name;
                tasks_answered += entry.runs_on == RunsOn::device
                                      ? entry.answers_task(task->name())
                                      : !entry.unsupported({nullptr, task, "serial", 1});
            }
            EXPECT_GT(tasks_answered, 0u) << entry.name;
            EXPECT_EQ(tasks_answered, entry.answers.size()) << entry.name;
        }
}

/// One that only says so makes a new tree in each frame, and takes as long.
TEST(Peers, ARefitCostsLessThanARebuild) {
    const Scene scene = scene_of(random_boxes(20'000, .02f, 1));
    Frame frame{random_boxes(20'000, .02f, 1), {}};
    for (std::uint32_t i = 0; i < frame.boxes.size(); ++i) {
        frame.boxes[i].max.x += .001f;
        frame.moved.push_back(i);
    }
    const Job job{&scene, find_task("moving_pairs")};
    std::map<std::string, double> least;
    std::map<std::string, std::unique_ptr<Contender>> made;
    for (const Peer& peer : peers())
        for (const ContenderEntry& entry : peer.contenders)
            if (entry.name == "embree.rtc_collide.refit" || entry.name == "embree.rtc_collide.low")
                made[entry.name] = entry.make(job);
    if (made.empty())
        GTEST_SKIP() << "libembree-dev was not found when this was compiled";
    for (const auto& [name, contender] : made) {
        contender->build();
        least[name] = std::numeric_limits<double>::infinity();
    }
    for (int round = 0; round < 9; ++round)
        for (const auto& [name, contender] : made) {
            const auto start = std::chrono::steady_clock::now();
            contender->update(frame);
            const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
            least[name] = std::min(least[name], took.count());
        }
    EXPECT_LT(least["embree.rtc_collide.refit"], .6 * least["embree.rtc_collide.low"]);
}

TEST(Tasks, AreFoundByTheirNames) {
    for (const Task* task : tasks()) {
        EXPECT_EQ(find_task(task->name()), task);
        EXPECT_FALSE(task->summary().empty());
        EXPECT_FALSE(task->keys().empty());
        EXPECT_EQ(task->make_answers()->size(), 0u);
    }
    EXPECT_EQ(find_task("pears"), nullptr);
}

TEST(Peers, GiveTheThreadsBack) {
    using tbb::global_control;
    const Scene scene = scene_of(random_boxes(10, 1, 1));
    const auto before = global_control::active_value(global_control::max_allowed_parallelism);
    for_each_way(scene, *find_task("pairs"), [&](const ContenderEntry& entry, const Job& job) {
        AnswerList<Pair> answers;
        {
            const auto contender = entry.make(job);
            contender->build();
            contender->query(answers);
        }
        EXPECT_EQ(global_control::active_value(global_control::max_allowed_parallelism), before)
            << entry.name;
    });
}

#if defined(__SSE2__)
TEST(Peers, LeaveTheFloatingPointModeAlone) {
    Scene scene = scene_of(random_boxes(500, 0.1f, 5));
    scene.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.mesh.triangles = {{0, 1, 2}};
    scene.rays.assign(1000, {{0.2f, 0.2f, -1}, {0, 0, 1}});
    const unsigned before = _mm_getcsr() & ~0x3fu; // without the sticky exception flags
    for (const Task* task : tasks()) {
        if (task->scenes() == SceneKind::cases)
            scene.cases = sample_of(*families_of("all", *task).front());
        for_each_way(scene, *task, [&](const ContenderEntry& entry, const Job& job) {
            {
                const auto answers = task->make_answers();
                const auto contender = entry.make(job);
                contender->build();
                contender->query(*answers);
            }
            EXPECT_EQ(_mm_getcsr() & ~0x3fu, before) << entry.name;
            volatile float tiny = std::numeric_limits<float>::min();
            EXPECT_GT(tiny / 4, 0.0f) << entry.name;
        });
    }
}
#endif

TEST(PeersOnRays, AgreeOnOneTriangle) {
    Scene scene;
    scene.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
    scene.mesh.triangles = {{3, 4, 5}, {0, 1, 2}};
    scene.rays = {{{0.25f, 0.5f, -1}, {0, 0, 2}},           // both: the nearer
                  {{0.25f, 0.5f, 6}, {0, 0, -1}},           // from behind
                  {{0.75f, 0.75f, -1}, {0, 0, 1}},          // beside
                  {{0.25f, 0.5f, -1}, {0, 0, 1}, 2, 10},    // starts after the first
                  {{0.25f, 0.5f, -1}, {0, 0, 1}, 0, 0.5f},  // ends before the first
                  {{0.25f, 0.5f, -1}, {0, 0, 1}, 2, 5.5f}}; // between the two
    const std::vector<RayHit> expected{
        {0.5f, 0.25f, 0.5f, 1}, {1, 0.25f, 0.5f, 0}, {}, {6, 0.25f, 0.5f, 0}, {}, {}};
    for (const char* name : {"rays_closest", "rays_any"})
        for_each_way(scene, *find_task(name), [&](const ContenderEntry& entry, const Job& job) {
            SCOPED_TRACE(entry.name);
            const auto contender = entry.make(job);
            AnswerList<RayHit> answers;
            contender->build();
            contender->build();
            contender->query(answers);
            ASSERT_EQ(answers.list.size(), expected.size());
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const RayHit &found = answers.list[i], &wanted = expected[i];
                if (job.task->name() == "rays_any") {
                    EXPECT_EQ(found.hit(), wanted.hit()) << i;
                } else if (entry.library == "embree") {
                    // Its reciprocal of AVX2 is an ulp off, that of AVX-512 is not.
                    EXPECT_EQ(found.triangle, wanted.triangle) << i;
                    EXPECT_EQ(std::nextafter(found.t, wanted.t), wanted.t) << i;
                    EXPECT_EQ(std::nextafter(found.u, wanted.u), wanted.u) << i;
                    EXPECT_EQ(std::nextafter(found.v, wanted.v), wanted.v) << i;
                } else {
                    EXPECT_EQ(found, wanted) << i;
                }
            }
        });
}

} // namespace
} // namespace boxwood::bench
