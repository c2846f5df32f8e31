#include "kernels/registry.h"
#include "kernels/testing/every_target.h"
#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/testing/append_hits.h"
#include "trees/testing/brute_force_rays.h"
#include "trees/testing/each_builder.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/ray_scenes.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace boxwood {
namespace {

template <RayKernel K>
std::vector<std::pair<std::uint32_t, RayHit>> all_by_brute_force(const TriangleMesh& mesh,
                                                                 std::span<const Ray<float>> rays) {
    std::vector<std::pair<std::uint32_t, RayHit>> all;
    for (std::uint32_t r = 0; r < rays.size(); ++r) {
        const auto per_ray = K::prepare(rays[r]);
        std::vector<RayHit> hits;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            RayHit hit;
            if (!K::intersect(per_ray, rays[r], mesh.triangle(i), rays[r].t_max, hit))
                continue;
            hit.triangle = i;
            hits.push_back(hit);
        }
        std::ranges::stable_sort(hits, {}, &RayHit::t);
        for (const RayHit& hit : hits)
            all.emplace_back(r, hit);
    }
    return all;
}

/// Closest and any hits of one layout, on every instruction set and executor.
template <RayKernel K>
void expect_hits(const AnyLayout& layout, const TriangleMesh& mesh,
                 std::span<const Ray<float>> rays, std::span<const RayHit> expected) {
    const TriangleBlocks triangles = layout.triangles(mesh);
    on_every_target([&] {
        for (const ExecutorEntry& executor : executors()) {
            std::vector<RayHit> hits(rays.size()), any(rays.size());
            const auto run = executor.make(std::min(2u, executor.max_threads));
            layout.rays(rays, RayQuery::closest, K::name, triangles, *run, hits);
            layout.rays(rays, RayQuery::any, K::name, triangles, *run, any);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(hits[i].hit(), expected[i].hit()) << i;
                ASSERT_EQ(hits[i], expected[i]) << i;
                ASSERT_EQ(any[i].hit(), expected[i].hit()) << i;
            }
        }
        std::vector<RayHit> counted(rays.size());
        const Work work = layout.rays_counted(rays, RayQuery::closest, K::name, triangles, counted);
        EXPECT_EQ(work.answers,
                  static_cast<std::uint64_t>(std::ranges::count_if(expected, &RayHit::hit)));
        EXPECT_TRUE(std::ranges::equal(counted, expected));
    });
}

TEST_P(EachBuilder, RaysAgreeWithBruteForceForEveryLayoutExecutorAndInstructionSet) {
    const std::vector<Ray<float>> rays = test_rays();
    for (const TriangleMesh& mesh :
         {sphere(40), triangle_soup(3000), triangle_soup(1), triangle_soup(5), TriangleMesh{}}) {
        const std::vector<RayHit> expected = brute_force<Watertight>(mesh, rays);
        if (mesh.triangles.size() > 1000) {
            EXPECT_GT(std::ranges::count_if(expected, &RayHit::hit), 200);
        }
        const Tree tree = build(triangle_boxes(mesh));
        for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
            SCOPED_TRACE(entry.name);
            expect_hits<Watertight>(*entry.make(tree, serial()), mesh, rays, expected);
        }
    }
}

TEST(Rays, AgreeWithBruteForceForEveryKernel) {
    const std::vector<Ray<float>> all_rays = test_rays();
    for (const TriangleMesh& mesh : {sphere(20), triangle_soup(1000)})
        for (const KernelInfo& info : ray_kernels())
            with_kernel<RayKernels>(info.name, [&]<RayKernel K>(std::type_identity<K>) {
                // The boxes may lose what kernels without bounds hit beside a triangle: these get
                // the random rays alone, not those along the axes at vertices.
                const bool tight = K::name == "watertight" || K::name == "exact";
                const std::span rays = std::span(all_rays).first(tight ? all_rays.size() : 600);
                const std::vector<RayHit> expected = brute_force<K>(mesh, rays);
                for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
                    SCOPED_TRACE(std::string(K::name) + "." + std::string(entry.name));
                    const auto layout = entry.make(
                        builders()[0].make({})(triangle_boxes(mesh), serial()), serial());
                    expect_hits<K>(*layout, mesh, rays, expected);
                }
            });
}

TEST(Rays, FindEveryHitOnceForEveryWayExecutorAndInstructionSet) {
    const std::vector<Ray<float>> rays = test_rays();
    for (const TriangleMesh& mesh :
         {sphere(40), triangle_soup(3000), triangle_soup(1), triangle_soup(9), TriangleMesh{}}) {
        const auto expected = all_by_brute_force<Watertight>(mesh, rays);
        if (mesh.triangles.size() > 1000) {
            EXPECT_GT(expected.size(), rays.size());
        }
        const Tree tree = make_builder("median")(triangle_boxes(mesh), serial());
        for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
            SCOPED_TRACE(entry.name);
            const auto layout = entry.make(tree, serial());
            const TriangleBlocks triangles = layout->triangles(mesh);
            on_every_target([&] {
                for (const ExecutorEntry& executor : executors()) {
                    AppendHits sink;
                    const auto run = executor.make(std::min(2u, executor.max_threads));
                    layout->rays_all(rays, "watertight", triangles, *run, sink);
                    EXPECT_TRUE(sink.all == expected) << executor.name;
                }
            });
        }
    }
}

TEST(Rays, StopWhenTheSinkHasEnough) {
    const TriangleMesh mesh = sphere(20);
    const std::vector<Ray<float>> rays(5000, Ray<float>{{0, 0, 0}, {1, .3f, .2f}});
    class Three final : public HitSink {
      public:
        void begin(std::size_t, bool) override {}
        bool take(std::size_t, std::uint32_t, std::span<const RayHit>) override {
            return ++taken < 3;
        }
        void end() override {}
        int taken = 0;
    };
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        const auto layout =
            entry.make(make_builder("median")(triangle_boxes(mesh), serial()), serial());
        Three sink;
        layout->rays_all(rays, "watertight", layout->triangles(mesh), serial(), sink);
        EXPECT_EQ(sink.taken, 3) << entry.name;
    }
}

TEST(Rays, AreRightAtEveryScaleAndFarFromTheOrigin) {
    // Powers of two: the kernels answer the same, so the boxes must not lose anything either.
    const TriangleMesh plain = triangle_soup(60);
    for (const float scale : {0x1p-130f, 1.0f, 0x1p99f})
        for (const float offset : {0.0f, 1000.0f}) {
            TriangleMesh mesh = plain;
            for (Vec3<float>& v : mesh.vertices)
                v = (v + Vec3<float>{offset, -offset, offset}) * scale;
            std::vector<Ray<float>> rays = test_rays();
            for (Ray<float>& ray : rays) {
                ray.origin = (ray.origin + Vec3<float>{offset, -offset, offset}) * scale;
                ray.t_min = 0;
                ray.t_max = std::numeric_limits<float>::infinity();
            }
            rays.push_back({{NAN, 0, 0}, {1, 0, 0}});
            rays.push_back({{0, 0, 0}, {INFINITY, 0, 0}});
            rays.push_back({{0x1p127f, 0, 0}, {-1, 0, 0}});
            const std::vector<RayHit> expected = brute_force<Watertight>(mesh, rays);
            for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
                const auto layout =
                    entry.make(make_builder("median")(triangle_boxes(mesh), serial()), serial());
                SCOPED_TRACE(std::string(entry.name) + " " + std::to_string(scale) + " " +
                             std::to_string(offset));
                expect_hits<Watertight>(*layout, mesh, rays, expected);
            }
        }
}

TEST(Rays, HaveTheSameBlocksOnEveryExecutor) {
    for (const TriangleMesh& mesh :
         {triangle_soup(20000), triangle_soup(9), triangle_soup(1), TriangleMesh{}})
        for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
            const auto layout =
                entry.make(make_builder("median")(triangle_boxes(mesh), serial()), serial());
            const TriangleBlocks one = layout->triangles(mesh);
            // Nodes end in bytes that nobody writes or reads.
            const auto [size, used] = entry.name == "wide4"             ? std::pair{128, 112}
                                      : entry.name == "quantised8"      ? std::pair{128, 124}
                                      : entry.name.starts_with("wide8") ? std::pair{256, 224}
                                                                        : std::pair{448, 448};
            const auto same = [](const Buffer<std::byte>& a, const Buffer<std::byte>& b, int row,
                                 int read) {
                const auto stride = static_cast<std::size_t>(row);
                bool all = a.size() == b.size() && a.size() % stride == 0;
                for (std::size_t i = 0; all && i < a.size(); i += stride)
                    all = std::memcmp(a.data() + i, b.data() + i, static_cast<std::size_t>(read)) ==
                          0;
                return all;
            };
            EXPECT_EQ(mesh.triangles.empty(), !one.bounds.is_valid()) << entry.name;
            for (const auto& [name, executor] : every_executor()) {
                const TriangleBlocks other = layout->triangles(mesh, *executor);
                EXPECT_TRUE(same(one.nodes, other.nodes, size, used) &&
                            same(one.blocks, other.blocks, 32, 32) && one.root == other.root &&
                            one.bounds == other.bounds)
                    << entry.name << " " << name;
            }
        }
}

TEST(Rays, RefuseWrongArguments) {
    const TriangleMesh mesh = triangle_soup(10);
    const Tree tree = builders()[0].make({})(triangle_boxes(mesh), serial());
    const std::vector<Ray<float>> rays(3, Ray<float>{{0, 0, 0}, {1, 0, 0}});
    std::vector<RayHit> hits(3), few(2);
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        const auto layout = entry.make(tree, serial());
        const TriangleBlocks triangles = layout->triangles(mesh);
        EXPECT_THROW(layout->rays(rays, RayQuery::any, "nosuch", triangles, serial(), hits),
                     std::invalid_argument);
        EXPECT_THROW(layout->rays(rays, RayQuery::any, "watertight", triangles, serial(), few),
                     std::invalid_argument);
    }
}

} // namespace
} // namespace boxwood
