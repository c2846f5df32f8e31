/// The peer warp on the host's model of a device: our kernels traverse the trees that Warp's
/// library makes in the host's memory, by Warp's own functions.

#include <gtest/gtest.h>

#if !defined(BOXWOOD_WARP_LIBRARY)

TEST(Warp, IsTestedWhereItsPackageIs) {
    GTEST_SKIP() << "no NVIDIA Warp here: scripts/setup --with-warp puts it into build/warp";
}

#else

#include "bench/tasks/task.h"
#include "bench/truth/truth.h"
#include "scenes/moving/frames.h"
#include "trees/cuda/on_host.h"
#include "trees/cuda/testing/families.h"

#include <algorithm>

namespace boxwood::bench {

Peer warp_peer();

namespace {

/// f(entry, job) for each contender of the task, at both places of a device.
template <class F> std::size_t for_each_way(const Scene& scene, const char* task, const F& f) {
    std::size_t ways = 0;
    for (const ContenderEntry& entry : warp_peer().contenders)
        for (const std::string_view place : {device_executor, resident_executor}) {
            const Job job{&scene, find_task(task), std::string(place), 1};
            if (!entry.answers_task(task) || entry.unsupported(job))
                continue;
            SCOPED_TRACE(entry.name + ", " + job.executor);
            f(entry, job);
            ++ways;
        }
    return ways;
}

/// Twice: the second build is in place, and the second query has the room of the first.
void expect_right(const Scene& scene, const char* task, std::size_t n_ways) {
    const auto truth = find_task(task)->make_truth(scene, 1);
    const auto answers = find_task(task)->make_answers();
    const auto judge = [&](const ContenderEntry& entry, const Job& job) {
        const auto contender = entry.make(job);
        for (int again = 0; again < 2; ++again) {
            contender->build();
            contender->query(*answers);
            contender->fetch(*answers);
            const Judgement judgement = truth->judge(*answers, entry);
            EXPECT_NE(judgement.status, results::Status::wrong)
                << judgement.check.missing << " missing, " << judgement.check.extra << " extra";
        }
        const bool is_timed = job.executor == device_executor;
        EXPECT_EQ(contender->device_times(*answers).size(), is_timed ? 4u : 0u);
    };
    EXPECT_EQ(for_each_way(scene, task, judge), n_ways) << task;
}

TEST(Warp, FindsThePairsOfBruteForce) {
    for (const BoxFamily& family : cuda::device_families()) {
        SCOPED_TRACE(family.name);
        Scene scene;
        scene.boxes = family.boxes;
        on_host::set_seed(scene.boxes.size());
        expect_right(scene, "pairs", 8);
        expect_right(scene, "tree_pairs", 6);
    }
}

TEST(Warp, FindsWhatPointsAndRegionsMeet) {
    Scene scene;
    scene.boxes = random_boxes(500, .2f, 1);
    for (const Box& box : random_boxes(300, .3f, 2)) {
        scene.points.push_back(box.min);
        scene.regions.push_back(box);
    }
    scene.points.push_back(scene.boxes[7].max);
    expect_right(scene, "points", 6);
    scene.points.clear();
    expect_right(scene, "regions", 6);
}

TEST(Warp, MeetsTheTrianglesOfTheTruth) {
    SceneSpec spec;
    spec.generator = "sphere_mesh";
    spec.n = 500;
    spec.rays = "random";
    spec.n_rays = 700;
    const Scene scene = make_scene(spec);
    expect_right(scene, "rays_closest", 6);
    expect_right(scene, "rays_any", 6);
}

TEST(Warp, SaysWhereRaysHit) {
    Scene scene;
    scene.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
    scene.mesh.triangles = {{3, 4, 5}, {0, 1, 2}};
    scene.rays = {{{.25f, .5f, -1}, {0, 0, 2}},          // both: the nearer
                  {{.75f, .75f, -1}, {0, 0, 1}},         // beside
                  {{.25f, .5f, -1}, {0, 0, 1}, 0, .5f}}; // ends before the first
    const auto cast = [&](const ContenderEntry& entry, const Job& job) {
        const auto contender = entry.make(job);
        contender->build();
        AnswerList<RayHit> answers;
        contender->query(answers);
        contender->fetch(answers);
        EXPECT_EQ(answers.list, (std::vector<RayHit>{{.5f, .25f, .5f, 1}, {}, {}}));
    };
    EXPECT_EQ(for_each_way(scene, "rays_closest", cast), 6u);
}

std::vector<Frame> random_frames(bool with_absent) {
    std::vector<Frame> frames(4);
    for (unsigned f = 0; f < frames.size(); ++f) {
        frames[f].boxes = random_boxes(400, .2f, 10 + f);
        for (std::size_t i = f; with_absent && i < 400; i += 7)
            frames[f].boxes[i] = {};
    }
    return frames;
}

std::vector<Pair> pairs_by_two_loops(const std::vector<Box>& boxes) {
    std::vector<Pair> pairs;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        for (std::uint32_t j = i + 1; j < boxes.size(); ++j)
            if (overlaps(boxes[i], boxes[j]))
                pairs.push_back({i, j});
    return pairs;
}

/// Bodies move, and come and go but for cuBQL.
TEST(Warp, FollowsFrames) {
    for (const bool with_absent : {false, true}) {
        const std::vector<Frame> frames = random_frames(with_absent);
        Scene scene;
        scene.boxes = frames[0].boxes;
        const auto follow = [&](const ContenderEntry& entry, const Job& job) {
            if (with_absent && entry.name.starts_with("warp.cubql"))
                return;
            const auto contender = entry.make(job);
            contender->build();
            for (const Frame& frame : frames) {
                contender->update(frame);
                AnswerList<Pair> answers;
                contender->query(answers);
                std::ranges::sort(answers.list);
                EXPECT_EQ(answers.list, pairs_by_two_loops(frame.boxes));
            }
        };
        EXPECT_EQ(for_each_way(scene, "moving_pairs", follow), 5u);
    }
}

} // namespace
} // namespace boxwood::bench

#endif
