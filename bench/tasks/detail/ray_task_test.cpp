#include "bench/tasks/detail/ray_task.h"

#include "bench/truth/ray_truth.h"
#include "bench/truth/truth.h"
#include "trees/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

namespace boxwood::bench {
namespace {

std::vector<ContenderEntry> ours(std::string_view task, std::string_view kernel = "watertight") {
    std::vector<ContenderEntry> all;
    for (const BuilderEntry& builder : builders())
        for (const LayoutEntry& layout : layouts())
            all.push_back(find_task(task)->contender({.builder = std::string(builder.name),
                                                      .settings = {},
                                                      .layout = std::string(layout.name),
                                                      .kernel = std::string(kernel)}));
    return all;
}

std::vector<RayHit> hits_of(const ContenderEntry& contender, const Scene& scene) {
    const auto instance = contender.make(Job{&scene, find_task("rays_closest")});
    AnswerList<RayHit> answers;
    instance->build();
    instance->query(answers);
    return answers.list;
}

/// Rays on which two answers differ by more than rounding: a hit against a miss, or another t.
std::vector<std::size_t> differences(std::span<const RayHit> a, std::span<const RayHit> b) {
    std::vector<std::size_t> rays;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].hit() != b[i].hit() ||
            (a[i].hit() && std::abs(a[i].t - b[i].t) > 1e-5f * std::max(a[i].t, b[i].t)))
            rays.push_back(i);
    return rays;
}

constexpr std::size_t rays_of_a_kind = 20000;

/// A mesh and rays of three kinds, one after the other.
Scene with_rays_of_three_kinds(SceneSpec spec) {
    spec.n_rays = rays_of_a_kind;
    spec.rays = "primary";
    Scene scene = make_scene(spec);
    for (const char* kind : {"random", "ambient"}) {
        spec.rays = kind;
        std::ranges::copy(make_scene(spec).rays, std::back_inserter(scene.rays));
    }
    return scene;
}

/// Ours agrees with Embree on every ray but those on which the oracle, in double, says that an edge
/// is within rounding: there, ours is one of the right answers.
void expect_agreement_with_embree(const Scene& scene) {
    ASSERT_EQ(scene.rays.size(), 3 * rays_of_a_kind);
    const auto embree = std::ranges::find(peers(), "embree", &Peer::name);
    if (embree == peers().end())
        GTEST_SKIP() << "libembree-dev was not found when this was compiled";
    const RayOracle oracle(scene.mesh);
    std::map<std::string_view, std::vector<RayHit>> embrees;
    for (const std::string_view name : {"embree.rtc_intersect1", "embree.rtc_intersect1.robust"}) {
        const auto entry = std::ranges::find(embree->contenders, name, &ContenderEntry::name);
        ASSERT_NE(entry, embree->contenders.end());
        embrees[name] = hits_of(*entry, scene);
    }
    for (const ContenderEntry& contender : ours("rays_closest")) {
        const std::vector<RayHit> hits = hits_of(contender, scene);
        for (const auto& [name, theirs] : embrees) {
            SCOPED_TRACE(contender.name + " against " + std::string(name) + " on " + scene.name);
            const std::vector<std::size_t> rays = differences(hits, theirs);
            for (std::size_t kind = 0; kind < 3; ++kind)
                EXPECT_LE(std::ranges::count(rays, kind,
                                             [](std::size_t i) { return i / rays_of_a_kind; }),
                          rays_of_a_kind / 1000);
            for (const std::size_t i : rays) {
                const RayTruth truth = oracle.truth(scene.rays[i]);
                if (!hits[i].hit()) {
                    EXPECT_FALSE(truth.must_hit()) << "ray " << i << " leaks";
                    continue;
                }
                EXPECT_TRUE(std::ranges::any_of(truth.candidates,
                                                [&](const auto& candidate) {
                                                    const auto t = static_cast<double>(hits[i].t);
                                                    return candidate.triangle == hits[i].triangle &&
                                                           candidate.t_low <= t &&
                                                           t <= candidate.t_high &&
                                                           t <= truth.t_limit;
                                                }))
                    << "ray " << i;
            }
        }
    }
}

TEST(Rays, AgreeWithEmbreeOnAClosedMesh) {
    SceneSpec spec;
    spec.generator = "sphere_mesh";
    spec.n = 20000;
    expect_agreement_with_embree(with_rays_of_three_kinds(spec));
}

TEST(Rays, AgreeWithEmbreeOnTheBunny) {
    const std::filesystem::path bunny = "../shared/data/meshes/stanford-bunny.obj";
    if (!std::filesystem::exists(bunny))
        GTEST_SKIP() << bunny << " is not here: the sample meshes are no part of the project";
    SceneSpec spec;
    spec.generator = "mesh";
    spec.file = bunny;
    expect_agreement_with_embree(with_rays_of_three_kinds(spec));
}

TEST(Rays, NoneLeaksThroughTheEdgesAndVerticesOfAClosedMesh) {
    SceneSpec spec;
    spec.generator = "sphere_mesh";
    spec.n = 20000;
    Scene scene = make_scene(spec);
    std::set<std::array<std::uint32_t, 2>> edges;
    for (const auto& triangle : scene.mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            edges.insert({std::min(triangle[k], triangle[(k + 1) % 3]),
                          std::max(triangle[k], triangle[(k + 1) % 3])});
    Vec3<float> centre{};
    for (const Vec3<float>& vertex : scene.mesh.vertices)
        centre = centre + vertex * (1 / static_cast<float>(scene.mesh.vertices.size()));
    for (const Vec3<float>& vertex : scene.mesh.vertices)
        scene.rays.push_back({centre, vertex - centre});
    for (const auto& [a, b] : edges)
        for (const float s : {.5f, .3f, .99f}) {
            const Vec3<float> from = scene.mesh.vertices[a], to = scene.mesh.vertices[b];
            scene.rays.push_back({centre, from + (to - from) * s - centre});
        }
    ASSERT_GT(scene.rays.size(), 90000u);
    for (const char* kernel : {"watertight", "exact"})
        for (const ContenderEntry& contender : ours("rays_closest", kernel)) {
            const std::vector<RayHit> hits = hits_of(contender, scene);
            EXPECT_TRUE(std::ranges::all_of(hits, &RayHit::hit)) << contender.name;
        }
}

SceneSpec small_spec(const char* generator, const char* rays) {
    SceneSpec spec;
    spec.generator = generator;
    spec.n = 3000;
    spec.rays = rays;
    spec.n_rays = 1000;
    return spec;
}

template <class T> AnswerList<T> answers_of(const ContenderEntry& contender, const Job& job) {
    const auto instance = contender.make(job);
    AnswerList<T> answers;
    instance->build();
    instance->query(answers); // twice: nothing of the first stays
    instance->query(answers);
    return answers;
}

TEST(RaysAll, AreAllThereOnceWithEveryWayAndEmbree) {
    const Task& task = *find_task("rays_all");
    for (const char* generator : {"sphere_mesh", "triangle_soup"}) {
        const Scene scene = make_scene(small_spec(generator, "random"));
        const auto truth = task.make_truth(scene, 1);
        std::vector<ContenderEntry> contenders = ours("rays_all");
        std::ranges::copy(peers_that_answer("rays_all"), std::back_inserter(contenders));
        for (const ContenderEntry& contender : contenders)
            for (const unsigned threads : {1u, 2u}) {
                const Job job{&scene, &task, std::string(default_executor(threads)), threads};
                const auto answers = answers_of<Pair>(contender, job);
                const Judgement judged = truth->judge(answers, contender);
                EXPECT_NE(judged.status, Status::wrong)
                    << contender.name << ": " << judged.check.witness;
                EXPECT_GT(judged.check.n_expected, 1000u);
                EXPECT_EQ(task.hash(answers),
                          task.hash(answers_of<Pair>(contender, {&scene, &task})))
                    << contender.name;
            }
    }
}

TEST(RaysAll, AreJudgedWrongWhenOneIsMissingExtraOrTwiceThere) {
    const Task& task = *find_task("rays_all");
    const Scene scene = make_scene(small_spec("triangle_soup", "random"));
    const auto truth = task.make_truth(scene, 1);
    const ContenderEntry contender = task.contender({});
    const auto right = answers_of<Pair>(contender, {&scene, &task});
    const Judgement good = truth->judge(right, contender);
    ASSERT_EQ(good.check.missing + good.check.extra, 0u);
    const auto wrong = [&](const auto& change) {
        auto answers = right;
        change(answers.list);
        const Judgement judged = truth->judge(answers, contender);
        EXPECT_EQ(judged.status, Status::wrong);
        return judged.check;
    };
    const Pair first = right.list.front();
    EXPECT_EQ(wrong([](auto& pairs) { pairs.erase(pairs.begin()); }).missing, 1u);
    EXPECT_EQ(wrong([&](auto& pairs) { pairs.push_back(first); }).extra, 1u);
    EXPECT_EQ(wrong([](auto& pairs) { pairs.push_back({5000, 0}); }).extra, 1u);
    EXPECT_EQ(wrong([](auto& pairs) { pairs.push_back({0, 5000}); }).extra, 1u);
    // Of all triangles but a few this ray is known to pass beside.
    const results::Check worst = wrong([&](auto& pairs) {
        for (std::uint32_t i = 0; i < scene.mesh.triangles.size(); ++i)
            if (std::ranges::find(pairs, Pair{first.a, i}) == pairs.end())
                pairs.push_back({first.a, i});
    });
    EXPECT_GT(worst.extra, scene.mesh.triangles.size() - 100);
    EXPECT_THAT(worst.witness, testing::HasSubstr("extra"));
}

/// Calls check(task, answers, given) for each layout and both tasks: the answers to rays that are
/// traced in that order, the same with two threads, and those to a batch as it comes.
template <class Check> void against_the_given_order(const std::string& order, const Check& check) {
    for (const char* name : {"rays_closest", "rays_any"}) {
        const Task& task = *find_task(name);
        const Scene scene = make_scene(small_spec("triangle_soup", "random"));
        for (const LayoutEntry& layout : layouts()) {
            Choice choice;
            choice.layout = std::string(layout.name);
            const auto given = answers_of<RayHit>(task.contender(choice), {&scene, &task});
            choice.ray_order = order;
            const ContenderEntry other = task.contender(choice);
            EXPECT_EQ(other.name, "binned_sah." + choice.layout + "." + order + "_rays.watertight");
            const auto answers = answers_of<RayHit>(other, {&scene, &task});
            check(task, answers, given);
            EXPECT_EQ(answers_of<RayHit>(other, {&scene, &task, "tbb", 2}).list, answers.list)
                << other.name;
        }
    }
}

TEST(RaysBatches, SortedAnswerAsGivenForEveryWay) {
    against_the_given_order("sorted", [](const Task&, const auto& sorted, const auto& given) {
        EXPECT_EQ(sorted.list, given.list);
    });
    EXPECT_THROW(
        find_task("rays_any")->contender({"median", {}, "wide8", "watertight", "shuffled"}),
        std::invalid_argument);
}

TEST(RaysOfAPicture, TiledAnswerAsGivenAndOthersAreRefused) {
    for (const char* name : {"rays_closest", "rays_any"}) {
        const Task& task = *find_task(name);
        Choice choice;
        const Scene picture = make_scene(small_spec("triangle_soup", "primary"));
        const auto given = answers_of<RayHit>(task.contender(choice), {&picture, &task});
        choice.ray_order = "tiled";
        const ContenderEntry tiled = task.contender(choice);
        EXPECT_EQ(tiled.name, "binned_sah.wide8.tiled_rays.watertight");
        const auto answers = answers_of<RayHit>(tiled, {&picture, &task});
        EXPECT_EQ(task.hash(answers), task.hash(given));
        EXPECT_FALSE(tiled.cannot({&picture, &task}));
        const Scene other = make_scene(small_spec("triangle_soup", "random"));
        EXPECT_TRUE(tiled.cannot({&other, &task}));
    }
}

TEST(RaysOneByOne, AnswerAsABatchForEveryWay) {
    against_the_given_order("single", [](const Task& task, const auto& alone, const auto& given) {
        EXPECT_EQ(task.hash(alone), task.hash(given));
    });
}

TEST(RayClasses, SingleRaysAndBatchesAndWatertightOnesByThemselves) {
    using Classes = std::vector<std::string>;
    const auto of_ours = [](const char* order, const char* kernel) {
        return find_task("rays_any")
            ->contender({.settings = {}, .kernel = kernel, .ray_order = order})
            .classes;
    };
    EXPECT_EQ(of_ours("given", "plucker_f32"), Classes{"batches"});
    EXPECT_EQ(of_ours("sorted", "plucker_f32"), Classes{"batches"});
    EXPECT_EQ(of_ours("single", "watertight"), (Classes{"single rays", "watertight single rays"}));
    std::map<std::string, Classes> classes;
    for (const char* task : {"rays_closest", "rays_all"})
        for (const ContenderEntry& peer : peers_that_answer(task))
            classes[peer.name] = peer.classes;
    if (!classes.contains("embree.rtc_intersect1"))
        GTEST_SKIP() << "libembree-dev was not found when this was compiled";
    EXPECT_EQ(classes.at("embree.rtc_intersect1"), (Classes{"single rays", "batches"}));
    EXPECT_EQ(classes.at("embree.rtc_intersect8.robust"), Classes{"watertight batches"});
    EXPECT_EQ(classes.at("embree.rtc_intersect1.filter"), Classes{"batches"});
    EXPECT_EQ(classes.at("embree.rtc_occluded1.filter"), Classes{"batches"});
    EXPECT_EQ(classes.at("embree.rtc_intersect16.robust.high.coherent.tiles"),
              Classes{"watertight batches"});
}

/// A peer of tiles answers primary rays alone.
class PeersOnRaysOfAKind : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Kinds, PeersOnRaysOfAKind, ::testing::Values("random", "primary"),
                         [](const auto& p) { return std::string(p.param); });

TEST_P(PeersOnRaysOfAKind, AnswerRight) {
    for (const char* name : {"rays_closest", "rays_any"}) {
        const Task& task = *find_task(name);
        SceneSpec spec = small_spec("sphere_mesh", GetParam());
        spec.n_rays = 1003; // packets that are not full
        const Scene scene = make_scene(spec);
        const auto truth = task.make_truth(scene, 1);
        for (const ContenderEntry& peer : peers_that_answer(name))
            for (const unsigned threads : {1u, 2u}) {
                const Job job{&scene, &task, std::string(default_executor(threads)), threads};
                if (peer.unsupported(job))
                    continue;
                const Judgement judged = truth->judge(answers_of<RayHit>(peer, job), peer);
                EXPECT_NE(judged.status, Status::wrong)
                    << peer.name << ": " << judged.check.witness;
            }
    }
}

} // namespace
} // namespace boxwood::bench
