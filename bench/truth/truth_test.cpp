#include "bench/truth/truth.h"

#include "bench/tasks/detail/halves.h"
#include "bench/tasks/task.h"
#include "bench/truth/hit_truth.h"
#include "bench/truth/pair_truth.h"
#include "bench/truth/ray_truth.h"
#include "trees/queries/sinks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace boxwood::bench {
namespace {

Scene random_boxes(std::size_t n, float size) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0, 1);
    Scene scene;
    scene.boxes.resize(n);
    for (Aabb<float>& b : scene.boxes) {
        b.min = {unit(random), unit(random), unit(random)};
        b.max = b.min + Vec3<float>{size, size, size};
    }
    return scene;
}

using PairList = AnswerList<Pair>;
using HitList = AnswerList<RayHit>;

PairList all_overlaps(const Scene& scene, PairsOf what) {
    PairList answers;
    const std::size_t n = scene.boxes.size(), split = tree_pairs_split(n);
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < j; ++i)
            if (overlaps(scene.boxes[i], scene.boxes[j]) &&
                (what == PairsOf::all_boxes || (i < split && j >= split)))
                answers.list.push_back({i, j});
    return answers;
}

const ContenderEntry nobody;

class PairTruthTest : public testing::TestWithParam<PairsOf> {};

TEST_P(PairTruthTest, ExactOrWrongWithAWitness) {
    const Scene scene = random_boxes(9000, 0.02f);
    const auto truth = make_pair_truth(scene, GetParam(), 2);
    const PairList right = all_overlaps(scene, GetParam());
    ASSERT_GT(right.list.size(), 100u);

    const Task& task = *find_task("pairs");
    const auto judged = [&](const Answers& given) { return truth->judge(given, nobody); };
    EXPECT_EQ(judged(right).status, Status::exact);
    results::Check check = judged(right).check;
    EXPECT_EQ(check.oracle, "brute_force");
    EXPECT_EQ(check.n_expected, right.list.size());
    EXPECT_EQ(check.n_got, right.list.size());
    EXPECT_EQ(check.missing + check.extra, 0u);
    EXPECT_EQ(check.witness, "");

    PairList answers = right;
    std::ranges::reverse(answers.list);
    EXPECT_EQ(judged(answers).status, Status::exact);
    EXPECT_EQ(task.hash(answers), task.hash(right));

    const Pair lost = answers.list.back();
    answers.list.pop_back();
    EXPECT_EQ(judged(answers).status, Status::wrong);
    check = judged(answers).check;
    EXPECT_EQ(check.missing, 1u);
    EXPECT_EQ(check.extra, 0u);
    EXPECT_EQ(check.witness,
              "missing (" + std::to_string(lost.a) + "," + std::to_string(lost.b) + ")");
    EXPECT_NE(task.hash(answers), task.hash(right));

    answers.list.push_back({lost.b, lost.a}); // the right pair the wrong way round
    check = judged(answers).check;
    EXPECT_EQ(check.missing, 1u);
    EXPECT_EQ(check.extra, 1u);

    answers = right;
    answers.list.push_back(right.list[5]);
    EXPECT_EQ(judged(answers).status, Status::wrong);
    check = judged(answers).check;
    EXPECT_EQ(check.missing, 0u);
    EXPECT_EQ(check.extra, 1u);
    EXPECT_THAT(check.witness, testing::StartsWith("extra ("));

    answers = right;
    answers.list.push_back({3, 3});
    EXPECT_EQ(judged(answers).check.extra, 1u);
}

INSTANTIATE_TEST_SUITE_P(Tasks, PairTruthTest,
                         testing::Values(PairsOf::all_boxes, PairsOf::two_halves),
                         [](const auto& p) {
                             return p.param == PairsOf::all_boxes ? "pairs" : "tree_pairs";
                         });

TEST(PairTruth, SweepBeyondAllPairs) {
    // One row of touching unit cubes, so many that the oracle sweeps: the pairs are known. The
    // boxes are shuffled, so that the sweep must sort and map back.
    constexpr std::uint32_t n = 200'001;
    std::vector<std::uint32_t> place(n);
    for (std::uint32_t i = 0; i < n; ++i)
        place[i] = i;
    std::shuffle(place.begin(), place.end(), std::mt19937(1));
    Scene scene;
    scene.boxes.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto x = static_cast<float>(i);
        scene.boxes[place[i]] = {{x, 0, 0}, {x + 1, 1, 1}};
    }
    for (const PairsOf what : {PairsOf::all_boxes, PairsOf::two_halves}) {
        PairList answers;
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            const auto [a, b] = std::minmax(place[i], place[i + 1]);
            if (what == PairsOf::all_boxes || (a < n / 2 && b >= n / 2))
                answers.list.push_back({a, b});
        }
        const Judgement judged = make_pair_truth(scene, what, 2)->judge(answers, nobody);
        EXPECT_EQ(judged.check.oracle, "sweep");
        EXPECT_EQ(judged.status, Status::exact) << judged.check.witness;
    }
}

TEST(PairTruth, NoBoxesNoPairs) {
    const Scene scene;
    PairList answers;
    EXPECT_EQ(make_pair_truth(scene, PairsOf::all_boxes, 1)->judge(answers, nobody).status,
              Status::exact);
    answers.list.push_back({0, 1});
    EXPECT_EQ(make_pair_truth(scene, PairsOf::two_halves, 1)->judge(answers, nobody).status,
              Status::wrong);
}

/// A closed sphere of `around` x `along` quads, poles shared by fans.
TriangleMesh sphere(std::uint32_t around, std::uint32_t along) {
    TriangleMesh mesh;
    const double pi = std::numbers::pi;
    mesh.vertices.push_back({0, 0, 1});
    for (std::uint32_t i = 1; i < along; ++i)
        for (std::uint32_t j = 0; j < around; ++j) {
            const double a = pi * i / along, b = 2 * pi * j / around;
            mesh.vertices.push_back(Vec3<float>(
                Vec3<double>{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)}));
        }
    mesh.vertices.push_back({0, 0, -1});
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
        return 1 + (i - 1) * around + j % around;
    };
    const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    for (std::uint32_t j = 0; j < around; ++j) {
        mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
        for (std::uint32_t i = 1; i + 1 < along; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
        mesh.triangles.push_back({last, at(along - 1, j + 1), at(along - 1, j)});
    }
    return mesh;
}

Scene sphere_scene(std::size_t n_rays) {
    Scene scene;
    scene.mesh = sphere(32, 16);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (std::size_t i = 0; i < n_rays; ++i)
        scene.rays.push_back({{2 * unit(random), 2 * unit(random), 2 * unit(random)},
                              {unit(random), unit(random), unit(random)}});
    return scene;
}

/// Plain Moeller-Trumbore in double, with none of the oracle's code.
RayHit moeller_trumbore(const TriangleMesh& mesh, const Ray<float>& ray) {
    RayHit best;
    const Vec3<double> o(ray.origin), d(ray.direction);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle<float> tri = mesh.triangle(i);
        const Vec3<double> a(tri.a), e1 = Vec3<double>(tri.b) - a, e2 = Vec3<double>(tri.c) - a;
        const Vec3<double> p = cross(d, e2), s = o - a, q = cross(s, e1);
        const double det = dot(e1, p), u = dot(s, p) / det, v = dot(d, q) / det;
        const auto t = static_cast<float>(dot(e2, q) / det);
        if (det != 0 && u >= 0 && v >= 0 && u + v <= 1 && t >= ray.t_min && t <= ray.t_max &&
            t < best.t)
            best = {t, static_cast<float>(u), static_cast<float>(v), i};
    }
    return best;
}

HitList right_hits(const Scene& scene) {
    HitList answers;
    for (const Ray<float>& ray : scene.rays)
        answers.list.push_back(moeller_trumbore(scene.mesh, ray));
    return answers;
}

TEST(RaysTruth, CatchesEachKindOfWrongAnswer) {
    const Scene scene = sphere_scene(600);
    const auto truth = make_hit_truth(scene, RayQuery::closest, 2);
    const HitList right = right_hits(scene);
    const Task& task = *find_task("rays_closest");
    const auto judged = [&](const Answers& given) { return truth->judge(given, nobody); };
    const results::Check check = judged(right).check;
    EXPECT_NE(judged(right).status, Status::wrong) << check.witness;
    EXPECT_EQ(check.n_checked, 600u);
    EXPECT_GT(check.n_expected, 60u);
    EXPECT_LT(check.n_expected, 550u);
    EXPECT_EQ(check.n_got, check.n_expected);
    EXPECT_LT(check.max_rel_err, 1e-5);

    const auto hit = static_cast<std::size_t>(std::ranges::find_if(right.list, &RayHit::hit) -
                                              right.list.begin());
    const auto miss = static_cast<std::size_t>(std::ranges::find_if_not(right.list, &RayHit::hit) -
                                               right.list.begin());
    const auto expect_wrong = [&](std::size_t ray, RayHit answer, std::uint64_t missing,
                                  std::uint64_t extra) {
        HitList answers = right;
        answers.list[ray] = answer;
        EXPECT_EQ(judged(answers).status, Status::wrong);
        const results::Check c = judged(answers).check;
        EXPECT_EQ(c.missing, missing);
        EXPECT_EQ(c.extra, extra);
        EXPECT_THAT(c.witness, testing::StartsWith("ray " + std::to_string(ray) + " "));
        EXPECT_NE(task.hash(answers), task.hash(right));
    };
    const RayHit good = right.list[hit];
    expect_wrong(hit, {}, 1, 0);
    expect_wrong(hit, {good.t * 1.001f, 0, 0, good.triangle}, 1, 0); // farther than the nearest
    expect_wrong(hit, {good.t * 0.999f, 0, 0, good.triangle}, 0, 1); // nearer than anything
    const auto n = static_cast<std::uint32_t>(scene.mesh.triangles.size());
    expect_wrong(hit, {good.t, 0, 0, (good.triangle + n / 2) % n}, 0, 1);
    expect_wrong(hit, {std::nanf(""), 0, 0, good.triangle}, 1, 0);
    expect_wrong(miss, {1, 0, 0, 3}, 0, 1);

    HitList answers = right;
    answers.list.pop_back();
    EXPECT_EQ(judged(answers).status, Status::wrong);
}

TEST(RaysTruth, AnyHit) {
    const Scene scene = sphere_scene(300);
    const auto truth = make_hit_truth(scene, RayQuery::any, 1);
    HitList answers = right_hits(scene);
    for (RayHit& hit : answers.list) // which triangle it was does not count
        if (hit.hit())
            hit.triangle = 0;
    const Task& task = *find_task("rays_any");
    const auto judged = [&](const Answers& given) { return truth->judge(given, nobody); };
    EXPECT_NE(judged(answers).status, Status::wrong);
    for (std::size_t i = 0; i < answers.list.size(); i += 50) {
        HitList changed = answers;
        changed.list[i] = answers.list[i].hit() ? RayHit{} : RayHit{1, 0, 0, 0};
        EXPECT_EQ(judged(changed).status, Status::wrong);
        const results::Check check = judged(changed).check;
        EXPECT_EQ(check.missing, answers.list[i].hit() ? 1u : 0u);
        EXPECT_EQ(check.extra, answers.list[i].hit() ? 0u : 1u);
        EXPECT_NE(task.hash(changed), task.hash(answers));
    }
}

TEST(RaysTruth, ASampleOfManyRaysIsSpread) {
    Scene scene = sphere_scene(1);
    scene.rays.assign(10'000, {{0, 0, 3}, {0.01f, 0.02f, -1}});
    HitList answers = right_hits(scene);
    const auto truth = make_hit_truth(scene, RayQuery::closest, 2);
    EXPECT_EQ(truth->judge(answers, nobody).check.n_checked, 1024u);
    EXPECT_EQ(truth->judge(answers, nobody).check.missing, 0u);
    for (std::size_t i = 9'000; i < 10'000; ++i)
        answers.list[i] = {};
    EXPECT_NEAR(static_cast<double>(truth->judge(answers, nobody).check.missing), 102, 2);
}

TEST(RayOracle, ClosedSurfaceMustBeHitThroughItsCorners) {
    const TriangleMesh mesh = sphere(32, 16);
    const RayOracle oracle(mesh);
    for (const Vec3<float> v : mesh.vertices) {
        const RayTruth truth = oracle.truth({{0, 0, 0}, v});
        EXPECT_TRUE(truth.must_hit());
        EXPECT_GE(truth.candidates.size(), 4u);
        EXPECT_NEAR(truth.t_limit, 1, 1e-4);
        for (const RayTruth::Candidate& c : truth.candidates)
            EXPECT_FALSE(c.certain);
    }
    const Vec3<float> a = mesh.vertices[40], b = mesh.vertices[41]; // through an edge
    EXPECT_TRUE(oracle.truth({{0, 0, 0}, 0.5f * (a + b)}).must_hit());
}

TEST(RayOracle, OpenEdgeMayBeHitOrMissed) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    const RayOracle oracle(mesh);
    const RayTruth edge = oracle.truth({{0.5f, 0, -1}, {0, 0, 1}});
    EXPECT_EQ(edge.candidates.size(), 1u);
    EXPECT_FALSE(edge.must_hit());
    const RayTruth inside = oracle.truth({{0.25f, 0.25f, -1}, {0, 0, 1}});
    EXPECT_TRUE(inside.must_hit());
    EXPECT_TRUE(inside.candidates.at(0).certain);
    EXPECT_DOUBLE_EQ(inside.candidates.at(0).t, 1);
    EXPECT_LT(inside.t_limit, 1 + 1e-5);
    EXPECT_TRUE(oracle.truth({{0.25f, -1e-3f, -1}, {0, 0, 1}}).candidates.empty());
    EXPECT_TRUE(oracle.truth({{0.25f, 0.25f, 1}, {0, 0, 1}}).candidates.empty()); // behind
    EXPECT_TRUE(oracle.truth({{0.25f, 0.25f, -1}, {0, 0, 1}, 0, 0.9f}).candidates.empty());
    const RayTruth at_end = oracle.truth({{0.25f, 0.25f, -1}, {0, 0, 1}, 0, 1});
    EXPECT_FALSE(at_end.must_hit());
    EXPECT_EQ(at_end.candidates.size(), 1u);
}

TEST(RayOracle, TriangleWithoutArea) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5f, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 0, 0}};
    const RayOracle oracle(mesh);
    EXPECT_FALSE(oracle.truth({{0.5f, 0, -1}, {0, 0, 1}}).must_hit());
    EXPECT_TRUE(oracle.truth({{0.5f, 3, -1}, {0, 0, 1}}).candidates.empty());
    EXPECT_TRUE(oracle.truth({{7, 0, -1}, {0, 0, 1}}).candidates.empty()); // on its line, far away
}

TEST(RaysTruth, EmbreeOnASphere) {
    Scene scene = sphere_scene(1000);
    int ways = 0;
    for (const Peer& peer : peers())
        for (const ContenderEntry& entry : peer.contenders)
            for (const char* name : {"rays_closest", "rays_any"})
                for (const unsigned threads : {1u, 2u}) {
                    const Task& task = *find_task(name);
                    const Job job{&scene, &task, "tbb", threads};
                    if (entry.unsupported(job))
                        continue;
                    ++ways;
                    const auto contender = entry.make(job);
                    HitList answers;
                    contender->build();
                    contender->query(answers);
                    const Judgement judged = task.make_truth(scene, 2)->judge(answers, entry);
                    EXPECT_NE(judged.status, Status::wrong)
                        << entry.name << ": " << judged.check.witness;
                }
    if (ways == 0)
        GTEST_SKIP() << "no peer with rays was compiled in: libembree-dev was not found";
}

} // namespace
} // namespace boxwood::bench
