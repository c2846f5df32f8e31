#include "bench/contender.h"
#include "bench/ours.h"
#include "bench/ray_truth.h"
#include "trees/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

namespace boxwood::bench {
namespace {

std::vector<ContenderEntry> ours(Ask ask, std::string_view kernel = "watertight") {
    std::vector<ContenderEntry> all;
    for (const BuilderEntry& builder : builders())
        for (const LayoutEntry& layout : layouts())
            all.push_back(our_contender({.builder = std::string(builder.name),
                                         .settings = {},
                                         .layout = std::string(layout.name),
                                         .kernel = std::string(kernel)},
                                        ask));
    return all;
}

std::vector<RayHit> hits_of(const ContenderEntry& contender, const Scene& scene) {
    const auto instance = contender.make(Job{&scene, Ask::rays_closest});
    Answers answers;
    instance->build();
    instance->query(answers);
    return answers.hits;
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

/// Ours agrees with Embree on every ray but those on which the oracle, in double, says that an edge
/// is within rounding: there, ours is one of the right answers.
void expect_agreement_with_embree(const Scene& scene) {
    const auto embree = std::ranges::find(peers(), "embree", &Peer::name);
    if (embree == peers().end())
        GTEST_SKIP() << "libembree-dev was not found when this was compiled";
    const RayOracle oracle(scene.mesh);
    for (const std::string_view name : {"embree.rtc_intersect1", "embree.rtc_intersect1.robust"}) {
        const auto entry = std::ranges::find(embree->contenders, name, &ContenderEntry::name);
        ASSERT_NE(entry, embree->contenders.end());
        const std::vector<RayHit> theirs = hits_of(*entry, scene);
        for (const ContenderEntry& contender : ours(Ask::rays_closest)) {
            SCOPED_TRACE(contender.name + " against " + entry->name + " on " + scene.name);
            const std::vector<RayHit> hits = hits_of(contender, scene);
            const std::vector<std::size_t> rays = differences(hits, theirs);
            EXPECT_LE(rays.size(), hits.size() / 1000);
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
    for (const char* rays : {"primary", "random", "ambient"}) {
        SceneSpec spec;
        spec.generator = "sphere_mesh";
        spec.n = 20000;
        spec.rays = rays;
        spec.n_rays = 20000;
        expect_agreement_with_embree(make_scene(spec));
    }
}

TEST(Rays, AgreeWithEmbreeOnTheBunny) {
    const std::filesystem::path bunny = "../shared/data/meshes/stanford-bunny.obj";
    if (!std::filesystem::exists(bunny))
        GTEST_SKIP() << bunny << " is not here";
    for (const char* rays : {"primary", "random", "ambient"}) {
        SceneSpec spec;
        spec.generator = "mesh";
        spec.file = bunny;
        spec.rays = rays;
        spec.n_rays = 20000;
        expect_agreement_with_embree(make_scene(spec));
    }
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
        for (const ContenderEntry& contender : ours(Ask::rays_closest, kernel)) {
            const std::vector<RayHit> hits = hits_of(contender, scene);
            EXPECT_TRUE(std::ranges::all_of(hits, &RayHit::hit)) << contender.name;
        }
}

} // namespace
} // namespace boxwood::bench
